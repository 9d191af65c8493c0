// A run that is resumed ends in the bits of one that was never interrupted, wherever its checkpoint was written.
#include <map>

#include "kernels/parallel.h"
#include "runtime/run_folder.h"
#include "tests/cases/every_stage.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

const char* const kEveryLook = "checkpoint.interval=1e-9";  // replaces those of stages' ends: the steps are the same
const char* const kStageEndsOnly = "checkpoint.interval=1e6";

// A finished run and all its checkpoints.
class FinishedRun {
 public:
  explicit FinishedRun(const std::string& when = kEveryLook, const std::vector<std::string>& overrides = {})
      : threads_before_(thread_count()), file_(write_every_stage(folder_.path())), overrides_(overrides) {
    RunOptions options;
    options.out = out(), options.threads = 2;
    const RunResult r = run_case(understood({when, "checkpoint.keep=1000"}), options);
    EXPECT_EQ(r.status, RunStatus::done) << r.message;
  }
  ~FinishedRun() { set_thread_count(threads_before_); }

  fs::path out() const { return folder_.path() / "whole"; }
  fs::path fresh_folder() { return folder_.path() / ("resumed_" + std::to_string(resumed_++)); }
  Case understood(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> overrides = overrides_;
    overrides.insert(overrides.end(), more.begin(), more.end());
    return read_case(file_, overrides);
  }

 private:
  TemporaryFolder folder_;
  int threads_before_, resumed_ = 0;
  std::string file_;
  std::vector<std::string> overrides_;
};

// One checkpoint from within each stage, and one from between any two: (what, path).
std::map<std::string, fs::path> moments(const fs::path& out, const Case& c) {
  std::map<uint64_t, std::vector<fs::path>> within, between;
  for (const fs::path& path : checkpoints_in(out)) {
    const RunState state = run_state_of(path);
    (state.begun ? within : between)[state.stage].push_back(path);
  }
  std::map<std::string, fs::path> result;
  for (const auto& [stage, paths] : within) result["within " + c.stages.at(stage).name] = paths[paths.size() / 2];
  for (const auto& [stage, paths] : between) result["after " + c.stages.at(stage - 1).name] = paths.front();
  return result;
}

class Resume : public ::testing::TestWithParam<const char*> {
 protected:
  void expect_the_same_from_each_moment(const char* when, const std::vector<std::string>& expected) {
    FinishedRun run(when, {std::string("contact.precision=") + GetParam()});
    std::vector<std::string> found;
    for (const auto& [what, checkpoint] : moments(run.out(), run.understood())) {
      SCOPED_TRACE(what);
      found.push_back(what);
      const fs::path out = run.fresh_folder();
      make_died_run(out, checkpoint);
      const RunResult r = resume_in(out, run.understood(), found.size() % 2 ? 1 : 3);
      ASSERT_EQ(r.status, RunStatus::done) << r.message;
      expect_same_results(out, run.out());
    }
    EXPECT_EQ(found, expected);
  }
};

TEST_P(Resume, FromWithinAStageEndsInTheSameBitsOnAnyNumberOfThreads) {
  expect_the_same_from_each_moment(kEveryLook,
                                   {"after drain", "within drain", "within fall", "within pour", "within settle"});
}

// Of stages that end at the same step the last one's checkpoint stays.
TEST_P(Resume, FromAStagesEndEndsInTheSameBitsOnAnyNumberOfThreads) {
  expect_the_same_from_each_moment(kStageEndsOnly,
                                   {"after drain", "after fill", "after open", "after pour", "after read"});
}

INSTANTIATE_TEST_SUITE_P(Precisions, Resume, ::testing::Values("mixed", "reference"));

TEST(Checkpoint, WritingOneChangesNothing) {
  FinishedRun run;
  const fs::path out = run.fresh_folder();
  RunOptions options;
  options.out = out;
  run_case(run.understood({"checkpoint.keep=0"}), options);
  EXPECT_FALSE(fs::exists(out / "checkpoints"));
  expect_same_results(out, run.out());
}

TEST(Checkpoint, TheLastOnesStayAndSummaryCountsThem) {
  const TemporaryFolder folder;
  const Case c = read_case(write_every_stage(folder.path()), {"checkpoint.keep=3"});
  RunOptions options;
  options.out = folder.path() / "out";
  run_case(c, options);
  const auto left = checkpoints_in(options.out);
  EXPECT_EQ(left.size(), 3u);
  EXPECT_EQ(run_state_of(left.front()).stage, c.stages.size());
  const nlohmann::json s = read_summary(options.out);
  EXPECT_EQ(s["checkpoints"]["written"], c.stages.size());
  EXPECT_GT(s["checkpoints"]["seconds"], 0.0);
}

// ---- what is refused

struct Told {
  RunResult result;
  std::string text;
};

Told resume_telling(const fs::path& out, const Case& c) {
  Told told;
  RunOptions options;
  options.out = out, options.resume = true;
  options.tell = [&](const std::string& line) { told.text += line + "\n"; };
  told.result = run_case(c, options);
  return told;
}

std::string refusal(const fs::path& out, const Case& c) {
  try {
    resume_in(out, c);
  } catch (const RunRefused& e) {
    return e.what();
  }
  return "";
}

// Damages the newest checkpoint in some way.
struct Fault {
  const char* name;
  void (*damage)(const fs::path& checkpoint);
  const char* reason;
};

void flip_the_middle(const fs::path& path) {
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  const auto middle = static_cast<std::streamoff>(fs::file_size(path) / 2);
  file.seekg(middle);
  const char c = static_cast<char>(file.get() ^ 0x10);
  file.seekp(middle);
  file.put(c);
}

void change_the_format(const fs::path& path) {
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(20);
  file.put(77);
}

void put_another_cases(const fs::path& path) {
  FinishedRun other(kStageEndsOnly, {"seed=12"});
  fs::copy_file(checkpoints_in(other.out()).front(), path, fs::copy_options::overwrite_existing);
}

const Fault kFaults[] = {
    {"truncated", [](const fs::path& p) { fs::resize_file(p, fs::file_size(p) * 2 / 3); }, "truncated"},
    {"empty", [](const fs::path& p) { fs::resize_file(p, 0); }, "not a checkpoint"},
    {"bits flipped", flip_the_middle, "damaged"},
    {"not HDF5", [](const fs::path& p) { std::ofstream(p) << std::string(9000, '#'); }, "not a checkpoint"},
    {"other version", change_the_format, "another version"},
    {"of another case", put_another_cases, "it belongs to another case: key 'seed' was 12 and is now 1"},
    {"a folder of that name", [](const fs::path& p) { fs::remove(p), fs::create_directory(p); }, "cannot be read"},
};

TEST(Resume, RefusesADamagedCheckpointAndTakesTheOneBefore) {
  FinishedRun run;
  const auto all = checkpoints_in(run.out());
  const fs::path newest = all[all.size() / 3], before = all[all.size() / 3 + 1];
  for (const Fault& fault : kFaults) {
    SCOPED_TRACE(fault.name);
    const fs::path out = run.fresh_folder();
    make_died_run(out, before), make_died_run(out, newest);
    std::ofstream(out / "checkpoints" / "step_999999999999.h5.part") << "a killed writer's";
    fault.damage(out / "checkpoints" / newest.filename());
    const Told told = resume_telling(out, run.understood());
    EXPECT_EQ(told.result.status, RunStatus::done) << told.result.message;
    EXPECT_NE(told.text.find(fault.reason), std::string::npos) << told.text;
    EXPECT_NE(told.text.find("resumed from " + before.filename().string()), std::string::npos) << told.text;
    EXPECT_TRUE(fs::exists(out / "checkpoints" / (newest.filename().string() + ".refused")));
    EXPECT_FALSE(fs::exists(out / "checkpoints" / "step_999999999999.h5.part"));
    expect_same_results(out, run.out());
  }
}

TEST(Resume, RefusesWhenNoCheckpointIsUsableAndTouchesNothing) {
  FinishedRun run;
  const fs::path out = run.fresh_folder();
  fs::copy(run.out(), out);
  make_died_run(out, checkpoints_in(run.out())[1]);
  flip_the_middle(checkpoints_in(out)[0]);
  const std::string why = refusal(out, run.understood());
  EXPECT_NE(why.find("damaged"), std::string::npos) << why;
  expect_same_results(out, run.out());
}

TEST(Resume, RefusesAnotherCaseAndNamesTheKey) {
  FinishedRun run;
  const fs::path out = run.fresh_folder();
  make_died_run(out, checkpoints_in(run.out())[1]);
  const std::string why = refusal(out, run.understood({"material.glass.poisson_ratio=0.23"}));
  EXPECT_NE(why.find("'material.glass.poisson_ratio' was 0.22 and is now 0.23"), std::string::npos) << why;
}

TEST(Resume, RefusesOtherWallsUnderTheSameText) {
  FinishedRun run;
  const fs::path out = run.fresh_folder();
  make_died_run(out, checkpoints_in(run.out())[1]);
  Case c = run.understood();
  c.solid.primitives.front().radius += 1e-12;
  EXPECT_NE(refusal(out, c).find("walls"), std::string::npos);
}

TEST(Resume, TakesAChangeThatDoesNotMatter) {
  FinishedRun run;
  const fs::path out = run.fresh_folder();
  make_died_run(out, checkpoints_in(run.out())[1]);
  const RunResult r = resume_in(out, run.understood({"title=renamed", "checkpoint.keep=5"}));
  EXPECT_EQ(r.status, RunStatus::done) << r.message;
  expect_same_results(out, run.out());
}

// Name and content of every field file.
std::map<std::string, std::string> field_files(const fs::path& out) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::directory_iterator(out / "fields"))
    files[entry.path().filename().string()] = text_of(entry.path());
  return files;
}

TEST(Resume, LeavesTheFieldFilesOfAnUninterruptedRun) {
  FinishedRun run(kEveryLook, {"output.fields.interval=2e-3", "output.fields.stage_ends=true"});
  const auto expected = field_files(run.out());
  EXPECT_GT(expected.size(), 12u);
  const auto all = checkpoints_in(run.out());
  for (const size_t at : {all.size() / 3, all.size() * 2 / 3}) {
    const fs::path out = run.fresh_folder();
    make_died_run(out, all[at]);
    fs::copy(run.out() / "fields", out / "fields");  // later frames, too, as a killed run leaves them
    std::ofstream(out / "fields" / "particles_999999999999.vtkhdf") << "of a run that was killed";
    std::ofstream(out / "fields" / "solid_000000000001.vtkhdf.part") << "of a killed writer";
    const RunResult r = resume_in(out, run.understood());
    ASSERT_EQ(r.status, RunStatus::done) << r.message;
    const auto found = field_files(out);
    for (const auto& [name, content] : expected) EXPECT_TRUE(found.contains(name) && found.at(name) == content) << name;
    EXPECT_EQ(found.size(), expected.size());
  }
}

TEST(Resume, TakesOtherFieldFilesFromThereOn) {
  FinishedRun run(kEveryLook, {"output.fields.stage_ends=false"});
  EXPECT_FALSE(fs::exists(run.out() / "fields"));
  const fs::path out = run.fresh_folder();
  make_died_run(out, checkpoints_in(run.out())[1]);
  const RunResult r = resume_in(out, run.understood({"output.fields.stage_ends=true"}));
  ASSERT_EQ(r.status, RunStatus::done) << r.message;
  EXPECT_EQ(read_summary(out)["fields"]["frames"], 1);
  expect_same_results(out, run.out());
}

TEST(Resume, RefusesResultsWithoutACheckpoint) {
  FinishedRun run;
  fs::remove_all(run.out() / "checkpoints");
  EXPECT_NE(refusal(run.out(), run.understood()).find("no checkpoint"), std::string::npos);
}

TEST(Resume, OfARunThatDiedBeforeItsFirstCheckpointBeginsAtTheStart) {
  FinishedRun run;
  const fs::path out = run.fresh_folder();
  const Told told = resume_telling(out, run.understood());
  EXPECT_EQ(told.result.status, RunStatus::done) << told.result.message;
  EXPECT_NE(told.text.find("begins at its start"), std::string::npos) << told.text;
  Case c = run.understood();
  expect_same_results(out, run.out());
}

// A jump of energy before a checkpoint is not seen by who goes on from it: each state is looked at before it is kept.
// Regular looks come ten times as rarely as these checkpoints, nearly all of which are written within stages.
TEST(Resume, EveryCheckpointIsOfAStateThatWasLookedAt) {
  const TemporaryFolder folder;
  RunOptions options;
  options.out = folder.path() / "out";
  const Case c = read_case(write_every_stage(folder.path()), {"checkpoint.interval=1e-9"});
  ASSERT_EQ(run_case(c, options).status, RunStatus::done);
  const nlohmann::json s = read_summary(options.out);
  const int written = s["checkpoints"]["written"], looks = s["energy_watch"]["looks"];
  ASSERT_GT(written, 50);
  EXPECT_GT(looks, written / 2);  // in the read and the pour some have nothing to be held against
}

// What a run that a check stopped leaves to be looked at.
void expect_failure_files(const fs::path& out) {
  int failed = 0;
  for (const auto& entry : fs::directory_iterator(out / "checkpoints"))
    failed += entry.path().filename().string().starts_with("failed_step_");
  EXPECT_EQ(failed, 1);
  const std::string picture = text_of(out / "failure.vtp");
  EXPECT_NE(picture.find("<VTKFile"), std::string::npos);
  EXPECT_EQ(picture.find("NumberOfPoints=\"0\""), std::string::npos) << "nothing lies round the place";
  EXPECT_EQ(read_summary(out)["status"], "failed");
}

// A failing run leaves its state to be looked at, and goes on from the last good one: to the same failure.
TEST(Resume, OfAFailedRunStartsFromTheLastGoodState) {
  const TemporaryFolder folder;
  const Case c = read_case(write_every_stage(folder.path()),
                           {"wall.box.open_faces=[\"bottom\", \"top\"]", "stage.pour.velocity=[0, 0, 5]"});
  RunOptions options;
  options.out = folder.path() / "out";
  const RunResult r = run_case(c, options);
  ASSERT_EQ(r.status, RunStatus::failed);
  EXPECT_NE(r.message.find("left the domain"), std::string::npos) << r.message;
  expect_failure_files(options.out);
  const Told again = resume_telling(options.out, c);
  EXPECT_EQ(again.result.message, r.message);
  EXPECT_NE(again.text.find("resumed from step_"), std::string::npos) << again.text;
}

// ---- what a stage reads fails the run

struct BadBeads {
  const char* what;
  const char* rows;
  const char* message;
};

TEST(Failure, ByOverlapOrSpeedNamesTheParticleAndLeavesFiles) {
  for (const BadBeads& bad :
       {BadBeads{"overlap", "0, 0, 0.032, 0.00075, 0, 0, 0\n0, 0, 0.0334, 0.00075, 0, 0, 0\n", "overlaps particle"},
        BadBeads{"speed", "0, 0, 0.03, 0.00075, 500, 0, 0\n", "moves at 500 m/s"}}) {
    SCOPED_TRACE(bad.what);
    const TemporaryFolder folder;
    const Case c = read_case(write_every_stage(folder.path()), {"watch.max_overlap=0.05"});
    std::ofstream(folder.path() / "beads.csv") << "x, y, z, radius, vx, vy, vz\n" << bad.rows;
    RunOptions options;
    options.out = folder.path() / "out";
    const RunResult r = run_case(c, options);
    EXPECT_EQ(r.status, RunStatus::failed);
    EXPECT_FALSE(r.bad_input);
    for (const char* part : {bad.message, "particle 30", " at t = ", "use a smaller [time] step"})
      EXPECT_NE(r.message.find(part), std::string::npos) << r.message;
    expect_failure_files(options.out);
    EXPECT_FALSE(r.checkpoint.empty());
  }
}

// The file is mended, and the run goes on to the bits of one that always had the good one.
TEST(Failure, ByABadFileOfAReadStageLeavesACheckpointAndASummary) {
  FinishedRun good(kStageEndsOnly);
  const TemporaryFolder folder;
  const Case c = read_case(write_every_stage(folder.path()));
  const std::string beads = text_of(folder.path() / "beads.csv");
  std::ofstream(folder.path() / "beads.csv") << "x, y, z, radius\n0, 0, 0.03, nan\n";
  RunOptions options;
  options.out = folder.path() / "out";
  const RunResult r = run_case(c, options);
  EXPECT_EQ(r.status, RunStatus::failed);
  EXPECT_TRUE(r.bad_input);
  EXPECT_NE(r.message.find("beads.csv:2:"), std::string::npos) << r.message;
  EXPECT_EQ(read_summary(options.out)["status"], "failed");
  ASSERT_FALSE(r.checkpoint.empty());
  EXPECT_TRUE(run_state_of(r.checkpoint).begun);
  std::ofstream(folder.path() / "beads.csv") << beads;
  const fs::path failure = options.out / "failure.vtp", failed = options.out / "checkpoints/failed_step_0000000001.h5";
  std::ofstream(failure) << "of an earlier failure", std::ofstream(failed) << "of an earlier failure";
  EXPECT_EQ(resume_in(options.out, c).status, RunStatus::done);
  expect_same_results(options.out, good.out());
  EXPECT_FALSE(fs::exists(failure)) << "a run that is done shows a failure";
  EXPECT_FALSE(fs::exists(failed));
}

}  // namespace
}  // namespace scree
