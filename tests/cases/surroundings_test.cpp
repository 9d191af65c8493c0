// What the machine can do to a run: clocks that jump, folders that cannot be written, memory that runs out. None
// changes a bit of what is computed, and what stops a run leaves a state that it goes on from.
#include <linux/capability.h>
#include <sys/prctl.h>

#include <regex>
#include <set>

#include "tests/cases/faults.h"
#include "tests/shadow_memory.h"

namespace scree {
namespace {

// ---- the wall clock

std::set<std::string> years_in(const fs::path& log) {
  std::set<std::string> years;
  std::ifstream file(log);
  const std::regex stamp(R"(^(\d{4})-\d\d-\d\d )");
  std::smatch date;
  for (std::string line; std::getline(file, line);)
    if (std::regex_search(line, date, stamp)) years.insert(date[1]);
  return years;
}

// Everything that waits for an interval asks the clock that only goes on: by one that jumps back, no checkpoint would
// be due for ten years, and by one that jumps ahead, one at every look.
TEST_F(Faults, AWallClockThatJumpsChangesNothing) {
  const auto jump = [] { setenv("LD_PRELOAD", SCREE_JUMPING_CLOCK, 1); };
  for (const char* interval : {"1e-9", "1e6"}) {
    SCOPED_TRACE(interval);
    const fs::path steady = path(std::string("steady") + interval), jumping = path(std::string("jumping") + interval);
    const std::vector<std::string> more{"--checkpoint-every", interval, "--set", "checkpoint.keep=1000"};
    ASSERT_EQ(execute(run_command(steady, more)), 0) << said_;
    ASSERT_EQ(execute(run_command(jumping, more), jump), 0) << said_;
    EXPECT_EQ(years_in(steady / "run.log").size(), 1u);
    EXPECT_GT(years_in(jumping / "run.log").size(), 1u) << "the clock did not jump";
    expect_undisturbed(jumping);
    EXPECT_EQ(checkpoints_in(jumping).size(), checkpoints_in(steady).size());
    const nlohmann::json summary = read_summary(jumping);
    EXPECT_GT(summary["wall_time_s"], 0);
    EXPECT_LT(summary["wall_time_s"], 1e6);
  }
}

// ---- folders that cannot be written

// Root may write anywhere, but for this: a process without the right to overrule permissions, and its children.
void obey_permissions() {
  prctl(PR_CAPBSET_DROP, CAP_DAC_OVERRIDE);
  prctl(PR_CAPBSET_DROP, CAP_DAC_READ_SEARCH);
}

class Unwritable {
 public:
  explicit Unwritable(const fs::path& folder) : folder_(folder) {
    allow(fs::perms::owner_read | fs::perms::owner_exec);
  }
  ~Unwritable() { allow(fs::perms::owner_all); }

 private:
  void allow(fs::perms rights) const { fs::permissions(folder_, rights); }
  fs::path folder_;
};

TEST_F(Faults, AReadOnlyPlaceForTheResultsIsNamed) {
  const fs::path place = path("read_only");
  fs::create_directories(place);
  {
    const Unwritable lock(place);
    EXPECT_EQ(execute(run_command(place / "out"), obey_permissions), 3);
    EXPECT_NE(said_.find("cannot make the results folder " + (place / "out").string()), std::string::npos) << said_;
    EXPECT_NE(said_.find("Permission denied"), std::string::npos) << said_;
  }
  EXPECT_FALSE(fs::exists(place / "out"));
}

TEST_F(Faults, AResultsFolderThatBecameReadOnlyStopsTheResumeAndHarmsNothing) {
  const fs::path out = path("frozen");
  const auto all = checkpoints_in(undisturbed());
  make_died_run(out, all[all.size() / 2]);
  fs::copy(undisturbed() / "case.toml", out / "case.toml");
  {
    const Unwritable lock(out);
    EXPECT_EQ(execute({"resume", out.string()}, obey_permissions), 3);
    EXPECT_NE(said_.find("Permission denied"), std::string::npos) << said_;
    EXPECT_NE(said_.find(out.string()), std::string::npos) << said_;
  }
  expect_resumes(out);
}

TEST_F(Faults, ACheckpointFolderThatBecomesReadOnlyMidwayStopsTheRun) {
  const fs::path out = path("midway");
  Process p(run_command(out, {"--checkpoint-every", "1e-9"}), path("said"), obey_permissions);
  wait_until([&] { return !checkpoints_in(out).empty(); });
  p.send(SIGSTOP);
  {
    const Unwritable lock(out / "checkpoints");
    p.send(SIGCONT);
    EXPECT_EQ(p.wait(), 3) << p.said();
  }
  EXPECT_NE(p.said().find("cannot write the checkpoint"), std::string::npos) << p.said();
  EXPECT_NE(p.said().find("Permission denied"), std::string::npos) << p.said();
  EXPECT_NE(p.said().find("scree resume"), std::string::npos) << p.said();
  expect_resumes(out);
}

// ---- memory

struct Attempt {
  int code = 0;
  std::string said;
  bool resumable = false;
};

TEST_F(Faults, MemoryThatRunsOutStopsTheRunWithAMessage) {
#ifdef SCREE_SHADOW_MEMORY
  GTEST_SKIP() << "a sanitizer's own memory has no such limit";
#endif
  const std::vector<std::string> grow{"--threads",     "1", "--checkpoint-every", "1e-9", "--set", "checkpoint.keep=3",
                                      "--force-memory"};
  const fs::path whole = path("whole");
  ASSERT_EQ(execute(run_command(whole, grow)), 0) << said_;
  const auto attempt = [&](rlim_t megabytes) {
    const fs::path out = path("limit_" + std::to_string(megabytes));
    Attempt a;
    a.code = execute(run_command(out, grow), [&] {
      const rlimit most{megabytes << 20, megabytes << 20};
      setrlimit(RLIMIT_AS, &most);
    });
    a.said = said_, a.resumable = !checkpoints_in(out).empty();
    EXPECT_TRUE(a.code == 0 || a.code == 3 || a.code == 127) << megabytes << " MB: " << a.code << "\n" << a.said;
    if (a.code == 3) {
      EXPECT_TRUE(std::regex_search(a.said, std::regex("memory|allocat"))) << a.said;
    }
    if (a.resumable) expect_resumes(out);
    return a;
  };
  // By halves to the least that suffices: the nearer to it, the later in the run memory ends.
  rlim_t low = 32, high = 16384;
  int stopped = 0, resumed = 0;
  while (high - low > 1) {
    const rlim_t middle = (low + high) / 2;
    const Attempt a = attempt(middle);
    stopped += a.code == 3, resumed += a.code == 3 && a.resumable;
    (a.code == 0 ? high : low) = middle;
  }
  EXPECT_GT(stopped, 0);
  EXPECT_GT(resumed, 0);
  RecordProperty("stopped", stopped);
  RecordProperty("resumed", resumed);
}

}  // namespace
}  // namespace scree
