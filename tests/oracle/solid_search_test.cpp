// The engine with Embree's index of the solid against its brute-force twin, and what the solid's lists must not forget.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "kernels/contacts.h"
#include "tests/oracle/beds.h"

namespace scree {
namespace {

EngineOptions with_brute_force(bool brute) {
  EngineOptions options;
  options.brute_force_solid = brute;
  return options;
}

struct Trace {
  std::vector<uint64_t> hashes;
  uint64_t removed = 0, rebuilds = 0;
};

// Grains fall through the small lattice; the lid opens after a while; what is below the lattice leaves.
Trace drain(Case c, const EngineOptions& options) {
  add_small_lattice(c);
  c.gravity = {0, 0, -9.81};
  const auto engine = make_engine(c, options);
  for (const double z : {-0.009, -0.0015}) {
    auto grains = LooseBed{4, 4, 12, 1.2e-4, 1.5e-4}.particles({-0.5 * 4 * 3.15e-4, -0.5 * 4 * 3.15e-4, z}, 3);
    if (z < -0.005)  // inside the lattice: where there is room
      std::erase_if(grains, [&](const ParticleState& g) {
        return std::ranges::any_of(c.solid.primitives,
                                   [&](const Primitive& p) { return distance(p, g.position) < g.radius; });
      });
    else
      for (ParticleState& g : grains) g.position.z += 0.002;
    for (ParticleState& g : grains) g.velocity = {0, 0, -0.2};
    engine->insert(grains);
  }
  engine->set_removal([](const ParticleState& p) { return p.position.z < -0.0105 ? 0 : -1; });
  Trace trace;
  for (int leg = 0; leg < 8; ++leg) {
    run_steps(*engine, 800);
    if (leg == 1) engine->open_walls({3});
    trace.hashes.push_back(engine->state_hash());
  }
  trace.removed = engine->counters().removed, trace.rebuilds = engine->counters().rebuilds;
  return trace;
}

TEST(SolidSearch, ByEmbreeAndByBruteForceDrainAlikeToTheLastBit) {
  const Case c = ceramic_case({{-0.005, -0.005, -0.012}, {0.005, 0.005, 0.02}});
  const Trace fast = drain(c, with_brute_force(false)), oracle = drain(c, with_brute_force(true));
  EXPECT_EQ(fast.hashes, oracle.hashes);
  EXPECT_EQ(fast.removed, oracle.removed);
  EXPECT_GT(fast.removed, 20u);
  EXPECT_GT(fast.rebuilds, 20u);
  EXPECT_EQ(std::set(fast.hashes.begin(), fast.hashes.end()).size(), fast.hashes.size());  // something moved
}

TEST(SolidSearch, ByEmbreeAndByBruteForceAgreeInAPeriodicBox) {
  Case c = ceramic_case({{-0.0025, -0.0025, -0.012}, {0.0025, 0.0025, 0.02}}, {'x', 'y'});
  // The lattice continues across the borders; no channel, no hopper.
  c.gravity = {0, 0, -9.81};
  c.solid.walls = {"lattice"};
  c.solid.primitives = fibre_primitives(octet_lattice(0.005, {1, 1, 2}, {-0.0025, -0.0025, -0.01}), 4e-4, {1, 0});
  std::vector<std::vector<uint64_t>> hashes;
  for (const bool brute : {false, true}) {
    const auto engine = make_engine(c, with_brute_force(brute));
    auto grains = LooseBed{15, 15, 2, 1.2e-4, 1.5e-4}.particles({-0.0025, -0.0025, 0.0003}, 4);
    for (ParticleState& g : grains) g.velocity = {0.05, 0.1, -0.2};
    engine->insert(grains);
    engine->set_removal([](const ParticleState& p) { return p.position.z < -0.0105 ? 0 : -1; });
    hashes.emplace_back();
    for (int leg = 0; leg < 5; ++leg) {
      run_steps(*engine, 500);
      hashes.back().push_back(engine->state_hash());
    }
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

// Velocities after one short step from rest tell the forces.
std::vector<ParticleState> after_one_step(const Case& c, const std::vector<std::vector<ParticleState>>& insertions,
                                          bool step_between) {
  const auto engine = make_engine(c);
  for (const auto& particles : insertions) {
    engine->insert(particles);
    if (step_between) engine->step();
  }
  engine->step();
  return by_id(*engine);
}

// The images of the solid that a periodic border needs depend on the largest particle, which may come late.
TEST(SolidSearch, LargeParticlesThatComeLaterFeelTheSolidAcrossAPeriodicBorder) {
  Case c = ceramic_case({{0, 0, 0}, {0.01, 0.01, 0.01}}, {'x'});
  c.solid.walls = {"fibre"};
  const double away = 0.6e-3, large = 1e-3;
  c.solid.primitives =
      fibre_network(std::vector{Segment{{0.01 - away, 2e-3, 5e-3}, {0.01 - away, 8e-3, 5e-3}}}, 1e-4, {1, 0});
  const ParticleState small = grain({5e-3, 5e-3, 2e-3}, 1e-4);
  const ParticleState late = grain({large + 5e-5 - away - 1e-5, 5e-3, 5e-3}, large);  // 10 um into the fibre's image
  const auto together = after_one_step(c, {{small, late}}, false), apart = after_one_step(c, {{small}, {late}}, true);
  ASSERT_GT(together[1].velocity.x, 1e-5);
  EXPECT_GT(apart[1].velocity.x, 1e-5);
}

// Two particles share a block of lanes: the one near many fibres, the other near many walls. Each must move as alone.
TEST(SolidSearch, ParticlesNearManyPrimitivesOfDifferentKindsDoNotDisturbEachOther) {
  Case c = ceramic_case({{-0.01, -0.01, -0.01}, {0.01, 0.01, 0.01}});
  c.solid.walls = {"star", "fan"};
  const Vec3 star{-5e-3, 0, 0}, fan{5e-3, 0, 0};
  const int each = kMaxSlots * 5 / 8;  // one alone fits, both in one block would not
  for (int k = 0; k < each; ++k) {
    const double angle = 2 * M_PI * k / each, next = angle + 2 * M_PI / each;
    const Vec3 a{std::cos(angle), std::sin(angle), 0}, b{std::cos(next), std::sin(next), 0};
    c.solid.primitives.push_back({Segment{star, star + 1e-3 * a}, 1e-5, 1, 0});
    c.solid.primitives.push_back({Quad{{fan, fan + 1e-3 * a, fan + 1e-3 * b, fan + 1e-3 * b}}, 0, 1, 1});
  }
  const ParticleState on_star = grain(star + Vec3{2e-5, 3e-5, 0.99 * kRadius}),
                      on_fan = grain(fan + Vec3{2e-5, 3e-5, 0.98 * kRadius});
  const auto both = after_one_step(c, {{on_star, on_fan}}, false);
  const auto first = after_one_step(c, {{on_star}}, false), second = after_one_step(c, {{on_fan}}, false);
  ASSERT_GT(first[0].velocity.z, 0);
  ASSERT_GT(second[0].velocity.z, 0);
  EXPECT_EQ(both[0].velocity.z, first[0].velocity.z);
  EXPECT_EQ(both[1].velocity.z, second[0].velocity.z);
}

}  // namespace
}  // namespace scree
