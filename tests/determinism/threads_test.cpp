// The same bits from any number of threads, from every instruction set, and from one run to the next.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "kernels/parallel.h"
#include "kernels/step_kernels.h"
#include "tests/oracle/beds.h"

namespace scree {
namespace {

// What a run went through, as far as two runs of one scene must agree.
struct Trace {
  std::vector<uint64_t> hashes;  // of the state, every leg
  std::vector<double> momenta;   // sums over particles
  uint64_t removed = 0, rebuilds = 0, near_checks = 0;
  bool operator==(const Trace&) const = default;
};

std::ostream& operator<<(std::ostream& out, const Trace& t) {
  for (const uint64_t h : t.hashes) out << fmt::format("{:016x} ", h);
  return out << fmt::format("removed {}, rebuilds {}, near checks {}", t.removed, t.rebuilds, t.near_checks);
}

struct Scene {
  RollingModel rolling = RollingModel::epsd2;
  bool several_materials = false, periodic = false, polydisperse = false;
  std::string name() const {
    return fmt::format("rolling {}{}{}{}", static_cast<int>(rolling), several_materials ? ", several materials" : "",
                       periodic ? ", periodic" : "", polydisperse ? ", polydisperse" : "");
  }
};

Case case_of(const Scene& scene) {
  Case c = ceramic_case({{-0.005, -0.005, -0.012}, {0.005, 0.005, 0.02}});
  c.gravity = {0, 0, -9.81};
  c.contact.rolling = scene.rolling;
  add_small_lattice(c);
  if (scene.periodic) {  // the lattice continues sideways; no channel, no hopper
    c.domain = {{-0.0025, -0.0025, -0.012}, {0.0025, 0.0025, 0.02}};
    c.periodic[0] = c.periodic[1] = true;
    std::erase_if(c.solid.primitives, [](const Primitive& p) { return p.wall == 1 || p.wall == 2; });
  }
  if (scene.several_materials) {
    c.materials.push_back({"heavy", kDensity, 2e7, 0.2});
    c.pairs.push_back({0, 2, 0.6, 0.3, 0.1});
    c.pairs.push_back({2, 2, 0.7, 0.4, 0.2});
    c.pairs.push_back({1, 2, 0.8, 0.2, 0.3});
    c.kinds.push_back(c.kinds[0]);
    c.kinds.back().name = "other", c.kinds.back().material = 2;
  }
  return c;
}

std::vector<ParticleState> wave(const Scene& scene, double z, int layers, uint32_t seed) {
  const double smallest = scene.polydisperse ? 6e-5 : 1.2e-4, largest = 1.2e-4;
  const double side = 19 * 2.1 * largest;
  auto grains = LooseBed{19, 19, layers, smallest, largest}.particles({-0.5 * side, -0.5 * side, z}, seed);
  Random random(seed);
  for (ParticleState& g : grains) {
    g.velocity = {random.between(-0.05, 0.05), 0.05, -0.3}, g.spin = {0, random.between(-9, 9), 1};
    g.kind = scene.several_materials ? random.below(2) : 0;
  }
  return grains;
}

// Charged lattice and a bed on the lid; a second wave comes; the lid opens; what falls out below leaves.
Trace run(const Scene& scene, int threads, const std::string& isa) {
  const int threads_before = thread_count();
  set_thread_count(threads);
  const Case c = case_of(scene);
  EngineOptions options;
  options.isa = isa;
  const auto engine = make_engine(c, options);
  auto charge = wave(scene, -0.0095, 8, 1);
  std::erase_if(charge, [&](const ParticleState& g) {
    return std::ranges::any_of(c.solid.primitives,
                               [&](const Primitive& p) { return distance(p, g.position) < g.radius; });
  });
  engine->insert(charge);
  engine->insert(wave(scene, 2e-4, 2, 2));
  engine->set_removal([](const ParticleState& p) { return p.position.z < -0.0097 ? 0 : -1; });
  Trace trace;
  for (int leg = 0; leg < 5; ++leg) {
    run_steps(*engine, 60);
    if (leg == 0) engine->insert(wave(scene, 1.3e-3, 1, 3));
    if (leg == 1) engine->open_walls({3});
    trace.hashes.push_back(engine->state_hash());
    trace.momenta.push_back(engine->sum([](const ParticleState& p) { return p.mass * p.velocity.z; }));
  }
  trace.removed = engine->counters().removed, trace.rebuilds = engine->counters().rebuilds;
  trace.near_checks = engine->counters().near_checks;
  set_thread_count(threads_before);
  return trace;
}

void expect_worth_comparing(const Trace& t) {
  EXPECT_GT(t.removed, 0u);
  EXPECT_GT(t.rebuilds, 5u);
  EXPECT_GT(t.near_checks, 0u);
  EXPECT_EQ(std::set(t.hashes.begin(), t.hashes.end()).size(), t.hashes.size());
}

TEST(Determinism, OfADrainDoesNotDependOnTheNumberOfThreads) {
  for (const Scene& scene : {Scene{}, Scene{RollingModel::cdt, true, true, true}}) {
    const Trace one = run(scene, 1, "");
    expect_worth_comparing(one);
    for (const int threads : {2, 3, 4, 8})
      EXPECT_EQ(run(scene, threads, ""), one) << threads << " threads, " << scene.name();
  }
}

TEST(Determinism, OfADrainRepeats) {
  const Trace first = run({}, 2, "");
  EXPECT_EQ(run({}, 2, ""), first);
}

// The hash sees a single particle's last bit.
TEST(Determinism, OfTheHashNoticesTheLastBit) {
  const Case c = ceramic_case({{0, 0, 0}, {1, 1, 1}});
  std::set<uint64_t> hashes;
  for (int k = 0; k < 4; ++k) {
    auto grains = LooseBed{5, 5, 5}.particles({0, 0, 0}, 1);
    if (k == 1) grains[77].position.y = std::nextafter(grains[77].position.y, 1);
    if (k == 2) grains[78].spin.z = 1e-30;
    if (k == 3) std::swap(grains[3].position, grains[4].position);
    const auto engine = make_engine(c);
    engine->insert(grains);
    hashes.insert(engine->state_hash());
  }
  EXPECT_EQ(hashes.size(), 4u);
}

class InstructionSets : public ::testing::TestWithParam<Scene> {};

TEST_P(InstructionSets, GiveTheSameBits) {
  const auto isas = available_isas();
  ASSERT_GE(isas.size(), 2u);
  const Trace first = run(GetParam(), 2, isas[0]);
  expect_worth_comparing(first);
  for (size_t k = 1; k < isas.size(); ++k)
    EXPECT_EQ(run(GetParam(), 1, isas[k]), first) << isas[k] << " against " << isas[0] << ", " << GetParam().name();
}

// Every two choices occur together.
std::vector<Scene> scenes() {
  std::vector<Scene> result;
  for (const RollingModel rolling : {RollingModel::none, RollingModel::cdt, RollingModel::epsd2})
    for (const int pick : {0, 1, 2, 3})
      result.push_back({rolling, pick == 1 || pick == 2, pick == 1 || pick == 3, pick == 2 || pick == 3});
  return result;
}

INSTANTIATE_TEST_SUITE_P(Determinism, InstructionSets, ::testing::ValuesIn(scenes()));

}  // namespace
}  // namespace scree
