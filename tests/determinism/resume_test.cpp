// An engine that is saved, and loaded by a fresh one with another number of threads, goes on to the same bits: at any
// moment, with valid lists and with histories that wait for new ones.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "kernels/parallel.h"
#include "runtime/state_archive.h"
#include "tests/oracle/beds.h"

namespace scree {
namespace {

struct Scene {
  Precision precision = Precision::mixed;
  bool periodic = false, polydisperse = false;
  std::string name() const {
    return fmt::format("{}{}{}", precision == Precision::mixed ? "mixed" : "reference", periodic ? ", periodic" : "",
                       polydisperse ? ", polydisperse" : "");
  }
};

Case case_of(const Scene& scene) {
  Case c = ceramic_case({{-0.005, -0.005, -0.012}, {0.005, 0.005, 0.02}});
  c.gravity = {0, 0, -9.81};
  c.contact.precision = scene.precision;
  add_small_lattice(c);
  if (scene.periodic) {
    c.domain = {{-0.0025, -0.0025, -0.012}, {0.0025, 0.0025, 0.02}};
    c.periodic[0] = c.periodic[1] = true;
    std::erase_if(c.solid.primitives, [](const Primitive& p) { return p.wall == 1 || p.wall == 2; });
  }
  return c;
}

std::vector<ParticleState> wave(const Scene& scene, double z, int layers, uint32_t seed) {
  const double smallest = scene.polydisperse ? 8e-5 : 1.6e-4, largest = 1.6e-4;
  auto grains =
      LooseBed{13, 13, layers, smallest, largest}.particles({-13 * 1.05 * largest, -13 * 1.05 * largest, z}, seed);
  for (ParticleState& g : grains) g.velocity = {0.02, 0.05, -0.3};
  return grains;
}

class Scenario {
 public:
  explicit Scenario(const Scene& scene) : case_(case_of(scene)), scene_(scene), engine_(fresh()) {}

  void insert(double z, uint32_t seed) { engine_->insert(wave(scene_, z, 2, seed)); }
  void open_lid() { engine_->open_walls({3}); }
  void steps(int n) { run_steps(*engine_, n); }
  void move_to_a_fresh_engine() {
    const auto path = std::filesystem::temp_directory_path() / fmt::format("scree_engine_{}.h5", getpid());
    {
      Hdf5Writer file(path);
      StateWriter out(file);
      engine_->save(out);
      file.close();
    }
    engine_ = fresh();
    Hdf5Reader file(path);
    StateReader in(file);
    engine_->load(in);
    std::filesystem::remove(path);
  }
  std::string state() const {
    const EngineCounters& k = engine_->counters();
    return fmt::format("{:016x} steps {} rebuilds {} near checks {} removed {} {} kg", engine_->state_hash(), k.steps,
                       k.rebuilds, k.near_checks, k.removed, k.removed_mass.empty() ? 0 : k.removed_mass[0]);
  }
  const EngineCounters& counters() const { return engine_->counters(); }

 private:
  std::unique_ptr<Engine> fresh() const {
    auto engine = make_engine(case_);
    engine->set_removal([](const ParticleState& p) { return p.position.z < -0.0097 ? 0 : -1; });
    return engine;
  }
  Case case_;
  Scene scene_;
  std::unique_ptr<Engine> engine_;
};

class SavedAndLoaded : public ::testing::TestWithParam<Scene> {};

TEST_P(SavedAndLoaded, AnEngineGoesOnToTheSameBits) {
  const int threads_before = thread_count();
  Scenario whole(GetParam()), moved(GetParam());
  int moves = 0;
  const auto move = [&] {
    moved.move_to_a_fresh_engine();
    EXPECT_EQ(moved.state(), whole.state()) << "after move " << moves;
    ++moves;
  };
  const auto steps = [&](int n) {
    set_thread_count(1);
    whole.steps(n);
    set_thread_count(1 + 2 * (moves % 2));
    moved.steps(n);
    ASSERT_EQ(moved.state(), whole.state()) << "after " << moves << " moves";
  };
  move();  // nothing in it yet
  for (Scenario* run : {&whole, &moved}) run->insert(2e-4, 1);
  move();
  for (const int n : {1, 1, 37, 61}) steps(n), move();
  for (Scenario* run : {&whole, &moved}) run->insert(1.5e-3, 2);  // histories wait
  move();
  for (const int n : {29, 1}) steps(n), move();
  for (Scenario* run : {&whole, &moved}) run->open_lid();
  move();
  for (const int n : {1, 100, 173}) steps(n), move();
  EXPECT_GT(whole.counters().rebuilds, 5u);
  EXPECT_GT(whole.counters().near_checks, 0u);
  set_thread_count(threads_before);
}

INSTANTIATE_TEST_SUITE_P(Determinism, SavedAndLoaded,
                         ::testing::Values(Scene{}, Scene{Precision::mixed, true, true},
                                           Scene{Precision::reference, false, true}));

}  // namespace
}  // namespace scree
