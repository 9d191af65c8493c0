// Averages and touch maps of a run: what it leaves, and that stopping and going on changes none of it.
#include "kernels/parallel.h"
#include "runtime/case_physics.h"
#include "tests/cases/every_stage.h"
#include "tests/cases/small_disk.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

// The example, a second long: fewer grains, coarse cells, early looks.
Case short_case(const std::vector<std::string>& more = {}) {
  std::vector<std::string> overrides{"stage.fill.count=900",
                                     "stage.settle.time=0.003",
                                     "stage.drain.max_time=0.012",
                                     "output.average.lattice.spacing=0.5e-3",
                                     "output.average.lattice.width=0.8e-3",
                                     "output.average.lattice.interval=1e-3",
                                     "output.average.filling.times=[0.003]",
                                     "output.average.filling.spacing=0.5e-3",
                                     "output.average.filling.width=0.8e-3",
                                     "output.touch.interval=2e-4"};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return read_case(case_path("examples/averages_and_touch.toml"), overrides);
}

RunResult run_in(const fs::path& out, const Case& c, int threads) {
  RunOptions options;
  options.out = out, options.threads = threads;
  return run_case(c, options);
}

nlohmann::json without_clock(nlohmann::json j) {
  j.erase("seconds");
  return j;
}

void expect_same_looks(const fs::path& a, const fs::path& b) {
  const nlohmann::json one = read_summary(a), other = read_summary(b);
  for (const char* key : {"average_lattice", "average_filling", "touch"})
    EXPECT_EQ(without_clock(one.at(key)), without_clock(other.at(key))) << key;
  for (const char* file : {"touch.csv", "touch/surface.vtkhdf", "averages/lattice.vtkhdf", "averages/filling.vtkhdf",
                           "averages/lattice_solid_fraction.png", "touch/every_fibre.png"}) {
    ASSERT_TRUE(fs::exists(a / file)) << file;
    EXPECT_TRUE(text_of(a / file) == text_of(b / file)) << file;
  }
}

// Of a run whose averages or touch maps could not be written.
void expect_the_rest_is_there(const fs::path& out) {
  ASSERT_TRUE(fs::exists(out / "summary.json"));
  const nlohmann::json s = read_summary(out);
  EXPECT_EQ(s["status"], "failed");
  EXPECT_NE(s["message"].get<std::string>().find("cannot write"), std::string::npos) << s["message"];
  EXPECT_EQ(s["particles"], 900);
  EXPECT_GT(fs::file_size(out / "particles.vtp"), 1000u);
  EXPECT_GT(read_table(out / "mass_flow.csv").rows.size(), 5u);
  EXPECT_TRUE(fs::exists(out / "residence.csv"));
  EXPECT_FALSE(checkpoints_in(out).empty());
}

class AveragesOfARun : public ::testing::Test {
 protected:
  void TearDown() override { set_thread_count(threads_before_); }
  TemporaryFolder folder_;
  int threads_before_ = thread_count();
};

TEST_F(AveragesOfARun, AreTheSameWhenItWasInterruptedAndOnAnyNumberOfThreads) {
  const fs::path whole = folder_.path() / "whole";
  ASSERT_EQ(run_in(whole, short_case({"checkpoint.interval=1e-9", "checkpoint.keep=1000"}), 2).status, RunStatus::done);
  const std::vector<fs::path> all = checkpoints_in(whole);
  ASSERT_GT(all.size(), 20u);
  int threads = 1;
  for (const size_t at : {all.size() / 4, all.size() / 2}) {  // within the drain
    const fs::path out = folder_.path() / ("resumed_" + std::to_string(at));
    make_died_run(out, all[at]);
    ASSERT_EQ(resume_in(out, short_case(), threads).status, RunStatus::done);
    expect_same_results(out, whole);
    expect_same_looks(out, whole);
    threads = 3;
  }
}

TEST_F(AveragesOfARun, ChangeNothingInIt) {
  const fs::path with = folder_.path() / "with", without = folder_.path() / "without";
  ASSERT_EQ(run_in(with, short_case(), 1).status, RunStatus::done);
  Case c = short_case();
  c.output.averages.clear(), c.output.touch.enabled = false;
  ASSERT_EQ(run_in(without, c, 1).status, RunStatus::done);
  EXPECT_EQ(read_summary(with)["state_hash"], read_summary(without)["state_hash"]);
  EXPECT_FALSE(fs::exists(without / "averages"));
  EXPECT_FALSE(fs::exists(without / "touch"));
}

TEST_F(AveragesOfARun, AreOfTheDrainAndHoldItsGrains) {
  const fs::path out = folder_.path() / "out";
  const Case c = short_case();
  ASSERT_EQ(run_in(out, c, 2).status, RunStatus::done);
  const nlohmann::json s = read_summary(out);
  EXPECT_EQ(s["average_filling"]["looks"], 1);
  EXPECT_GE(s["average_lattice"]["looks"].get<int>(), 11);
  EXPECT_GE(s["average_lattice"]["window_s"][0].get<double>(), 0.003);
  const double grain = sphere_mass(2e-4, 3071);
  EXPECT_NEAR(s["average_filling"]["mass_kg"].get<double>() / (900 * grain), 1, 1e-6);
  EXPECT_LE(s["average_lattice"]["mass_kg"].get<double>(), 900 * grain * (1 + 1e-6));
  EXPECT_LT(s["average_lattice"]["mean_velocity_m_per_s"][2].get<double>(), 0);
  EXPECT_GT(s["touch"]["looks"].get<int>(), 40);
  const auto& fibres = s["touch"]["fibres"];
  EXPECT_LT(fibres["dead_share"].get<double>(), 1);
  EXPECT_GT(fibres["upper_half"]["touched_share"].get<double>(), fibres["lower_half"]["touched_share"].get<double>());
}

TEST_F(AveragesOfARun, ADrainThroughALatticeHasThemByDefault) {
  const Case c = read_case(case_path("olhx/demo.toml"));
  ASSERT_EQ(c.output.averages.size(), 1u);
  EXPECT_EQ(c.output.averages[0].name, "lattice");
  EXPECT_EQ(c.output.averages[0].during, During::drain);
  EXPECT_TRUE(c.output.touch.enabled);
  EXPECT_EQ(c.output.touch.walls.size(), 3u);  // channel, hopper, bin; not the seal, which is opened
  const Case off =
      read_case(case_path("olhx/demo.toml"), {"output.default_average=false", "output.touch.enabled=false"});
  EXPECT_TRUE(off.output.averages.empty());
  EXPECT_FALSE(off.output.touch.enabled);
}

// A folder that is in the way: said, and the run's state is safe.
TEST_F(AveragesOfARun, NoPlaceForThemIsSaid) {
  const fs::path out = folder_.path() / "out";
  fs::create_directories(out);
  std::ofstream(out / "averages") << "a file where the folder should be";
  const RunResult r = run_in(out, short_case(), 2);
  EXPECT_EQ(r.status, RunStatus::failed);
  EXPECT_NE(r.message.find("cannot write " + (out / "averages").string()), std::string::npos) << r.message;
  EXPECT_FALSE(checkpoints_in(out).empty());
  expect_the_rest_is_there(out);
}

// A disk that is full when they are written, at the end: said; what else the run leaves is there, and once there is
// room it goes on from its last checkpoint to the same files.
class FullDiskUnderLooks : public AveragesOfARun, public ::testing::WithParamInterface<const char*> {};

TEST_P(FullDiskUnderLooks, IsSaidAndLeavesTheRest) {
  const std::string name = GetParam();
  const fs::path whole = folder_.path() / "whole", disk = folder_.path() / "disk", out = folder_.path() / "out";
  const SmallDisk small(disk, "16k");
  if (!small.mounted()) return small.try_in_a_namespace();
  ASSERT_EQ(run_in(whole, short_case(), 2).status, RunStatus::done);
  fs::create_directories(out);
  fs::create_directory_symlink(disk, out / name);
  const RunResult r = run_in(out, short_case(), 2);
  EXPECT_EQ(r.status, RunStatus::failed);
  EXPECT_NE(r.message.find((out / name).string() + "/"), std::string::npos) << r.message;
  EXPECT_NE(r.message.find("No space left on device"), std::string::npos) << r.message;
  expect_the_rest_is_there(out);
  EXPECT_TRUE(fs::exists(out / (name == "touch" ? "averages/lattice.vtkhdf" : "touch/surface.vtkhdf")));
  for (const auto& entry : fs::recursive_directory_iterator(disk)) {  // complete files or none
    const fs::path same = whole / name / entry.path().filename();
    EXPECT_TRUE(fs::exists(same) && text_of(entry.path()) == text_of(same)) << entry.path();
  }
  small.grow();
  EXPECT_EQ(resume_in(out, short_case()).status, RunStatus::done);
  expect_same_results(out, whole);
  expect_same_looks(out, whole);
}
INSTANTIATE_TEST_SUITE_P(OfARun, FullDiskUnderLooks, ::testing::Values("averages", "touch"));

}  // namespace
}  // namespace scree
