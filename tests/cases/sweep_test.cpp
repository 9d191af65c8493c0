// A sweep as a whole: it runs its table, skips what is done, goes on after a kill, and refuses what contradicts it.
#include <sys/wait.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <thread>

#include "tests/cases/case_runs.h"

namespace scree {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// A sweep of a small silo in a folder of its own.
class Sweep : public ::testing::Test {
 protected:
  Sweep() { write("[1, 2]", "0.3e-3", "0.03"); }

  void write(const std::string& seeds, const std::string& mass, const std::string& drain) const {
    std::ofstream(file()) << "case = \"" << case_path("examples/orifice_silo.toml") << "\"\nseeds = " << seeds << R"(
[set]
title = "it's small"
stage.settle.time = 0.01
time.rayleigh_fraction = 0.3
stage.fill.mass = )" << mass
                          << "\nstage.drain.max_time = " << drain
                          << "\n[[parameter]]\nkey = \"contact.rolling\"\nvalues = [\"cdt\", \"epsd2\"]\n";
  }
  fs::path file() const { return folder_.path() / "sweep.toml"; }
  fs::path out() const { return folder_.path() / "swept"; }
  fs::path run(const std::string& name) const { return out() / name; }
  std::string said() const { return text_of(folder_.path() / "said"); }

  // A process `scree sweep` with this test's file and folder; its output is said().
  pid_t start(std::vector<std::string> more = {}) const {
    std::vector<std::string> words = {SCREE_COMMAND, "sweep", file().string(), "--threads", "1"};
    if (!std::ranges::count(more, "--out")) more.insert(more.end(), {"--out", out().string()});
    words.insert(words.end(), more.begin(), more.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    const std::string to = (folder_.path() / "said").string();
    const pid_t pid = fork();
    if (pid != 0) return pid;
    if (!std::freopen(to.c_str(), "w", stdout) || dup2(STDOUT_FILENO, STDERR_FILENO) < 0) _exit(126);
    execv(SCREE_COMMAND, argv.data());
    _exit(127);
  }
  static int end_of(pid_t pid) {  // its exit code, or minus the signal
    int status = 0;
    waitpid(pid, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }
  int sweep(const std::vector<std::string>& more = {}) const { return end_of(start(more)); }

  static void wait_for(const fs::path& path) {
    const auto limit = std::chrono::steady_clock::now() + 120s;
    while (!fs::exists(path) && std::chrono::steady_clock::now() < limit) std::this_thread::sleep_for(5ms);
    ASSERT_TRUE(fs::exists(path)) << path;
  }
  static std::string hash_of(const fs::path& folder) { return read_summary(folder).at("state_hash"); }

  // The hash of a run of the sweep that nothing disturbed, in a folder of its own.
  std::string undisturbed(const std::string& rolling, const std::string& seed, const std::string& mass,
                          const std::string& drain) const {
    const RunResult r = run_to(folder_.path() / "undisturbed", "examples/orifice_silo.toml",
                               {"stage.settle.time=0.01", "time.rayleigh_fraction=0.3", "stage.fill.mass=" + mass,
                                "stage.drain.max_time=" + drain, "contact.rolling=" + rolling, "seed=" + seed});
    return hash_of(r.out);
  }

  TemporaryFolder folder_;
};

constexpr const char* kRuns[] = {"rolling_cdt__seed_1", "rolling_cdt__seed_2", "rolling_epsd2__seed_1",
                                 "rolling_epsd2__seed_2"};

TEST_F(Sweep, leaves_a_folder_for_each_run_a_table_and_a_report) {
  ASSERT_EQ(sweep({"--jobs", "2"}), 0) << said();
  for (const char* name : kRuns) {
    EXPECT_EQ(read_summary(run(name))["status"], "done") << name;
    EXPECT_TRUE(fs::exists(run(name) / "report.html")) << name;
  }
  EXPECT_EQ(read_summary(run(kRuns[3]))["title"], "it's small");
  EXPECT_EQ(hash_of(run(kRuns[3])), undisturbed("epsd2", "2", "0.3e-3", "0.03"));
  EXPECT_NE(hash_of(run(kRuns[3])), hash_of(run(kRuns[2])));
  EXPECT_NE(hash_of(run(kRuns[3])), hash_of(run(kRuns[1])));
  EXPECT_TRUE(fs::exists(out() / "report.html"));
  std::istringstream table(text_of(out() / "sweep.csv"));
  std::string line;
  std::getline(table, line);
  EXPECT_TRUE(line.starts_with("run,rolling,seed,status,steady_mass_flow_kg_per_s,")) << line;
  for (const char* name : kRuns) {
    std::getline(table, line);
    EXPECT_TRUE(line.starts_with(std::string(name) + ",")) << line;
    EXPECT_NE(line.find(",done,"), std::string::npos) << line;
  }
  EXPECT_FALSE(std::getline(table, line));
}

TEST_F(Sweep, runs_that_are_done_are_skipped_and_new_ones_added) {
  write("[1]", "0.3e-3", "0.03");
  ASSERT_EQ(sweep(), 0) << said();
  const auto written = fs::last_write_time(run(kRuns[0]) / "summary.json");
  write("[1, 2]", "0.3e-3", "0.03");
  ASSERT_EQ(sweep(), 0) << said();
  EXPECT_NE(said().find("4 runs, 2 of them done already"), std::string::npos) << said();
  EXPECT_EQ(fs::last_write_time(run(kRuns[0]) / "summary.json"), written);
  EXPECT_EQ(read_summary(run(kRuns[3]))["status"], "done");
}

TEST_F(Sweep, asked_to_stop_its_runs_save_their_states_and_a_repeat_goes_on) {
  write("[1]", "2e-3", "0.1");
  const pid_t pid = start();
  wait_for(run(kRuns[0]) / "mass_flow.csv");
  kill(pid, SIGINT);
  ASSERT_EQ(end_of(pid), 130) << said();
  EXPECT_EQ(read_summary(run(kRuns[0]))["status"], "interrupted");
  EXPECT_FALSE(fs::exists(run(kRuns[2]))) << "nothing new begins";
  EXPECT_TRUE(fs::exists(out() / "report.html"));
  ASSERT_EQ(sweep(), 0) << said();
  EXPECT_FALSE(read_summary(run(kRuns[0]))["resumed_from"].is_null());
  EXPECT_EQ(hash_of(run(kRuns[0])), undisturbed("cdt", "1", "2e-3", "0.1"));
}

TEST_F(Sweep, killed_itself_its_runs_save_their_states_and_a_repeat_goes_on) {
  write("[1]", "2e-3", "0.1");
  const pid_t pid = start();
  wait_for(run(kRuns[0]) / "mass_flow.csv");
  kill(pid, SIGKILL);
  ASSERT_EQ(end_of(pid), -SIGKILL);
  wait_for(run(kRuns[0]) / "report.html");  // the last that a run does
  EXPECT_EQ(read_summary(run(kRuns[0]))["status"], "interrupted");
  ASSERT_EQ(sweep(), 0) << said();
  EXPECT_EQ(hash_of(run(kRuns[0])), undisturbed("cdt", "1", "2e-3", "0.1"));
}

TEST_F(Sweep, a_run_that_is_killed_is_told_the_others_go_on_and_a_repeat_makes_it_whole) {
  write("[1]", "2e-3", "0.1");
  const pid_t pid = start();
  wait_for(run(kRuns[0]) / "mass_flow.csv");
  const pid_t child = static_cast<pid_t>(std::stol(text_of(run(kRuns[0]) / "lock")));
  ASSERT_GT(child, 1);
  kill(child, SIGKILL);
  EXPECT_EQ(end_of(pid), 3) << said();
  EXPECT_NE(said().find("rolling_cdt__seed_1: ended with code 137"), std::string::npos) << said();
  EXPECT_EQ(read_summary(run(kRuns[2]))["status"], "done");
  ASSERT_EQ(sweep(), 0) << said();
  EXPECT_EQ(hash_of(run(kRuns[0])), undisturbed("cdt", "1", "2e-3", "0.1"));
}

TEST_F(Sweep, a_changed_file_that_contradicts_a_run_is_refused_with_the_key) {
  write("[1]", "0.3e-3", "0.03");
  ASSERT_EQ(sweep(), 0) << said();
  const std::string hash = hash_of(run(kRuns[0]));
  write("[1]", "0.4e-3", "0.03");
  EXPECT_EQ(sweep(), 2);
  EXPECT_NE(
      said().find("holds a run of another case than the sweep file describes now: key 'stage.fill.mass' was 0.0003 "
                  "and is now 0.0004"),
      std::string::npos)
      << said();
  EXPECT_EQ(hash_of(run(kRuns[0])), hash);
}

TEST_F(Sweep, a_wrong_file_is_bad_input) {
  std::ofstream(file(), std::ios::app) << "colour = \"red\"\n";
  EXPECT_EQ(sweep(), 2);
  EXPECT_NE(said().find("colour"), std::string::npos) << said();
  EXPECT_FALSE(fs::exists(out()));
}

TEST_F(Sweep, a_folder_that_cannot_be_made_is_named) {
  struct Row {
    const char* what;
    std::string out, expected;
  };
  const std::string in_the_way = (folder_.path() / "in_the_way").string();
  std::ofstream(in_the_way) << "a file\n";
  for (const Row& row :
       {Row{"a file in its place", in_the_way, "cannot make the results folder " + in_the_way + ": "},
        Row{"a file above it", in_the_way + "/swept",
            "cannot make the results folder " + in_the_way + "/swept: Not a directory"},
        Row{"where nobody may write", "/proc/swept", "cannot make the results folder /proc/swept: "}}) {
    SCOPED_TRACE(row.what);
    EXPECT_EQ(sweep({"--out", row.out}), 3);
    EXPECT_NE(said().find(row.expected), std::string::npos) << said();
    EXPECT_EQ(said().find("runs,"), std::string::npos) << "it began: " << said();
  }
}

TEST_F(Sweep, a_run_whose_folder_cannot_be_made_is_told_and_the_others_go_on) {
  write("[1]", "0.3e-3", "0.03");
  fs::create_directories(out());
  std::ofstream(run(kRuns[0])) << "a file\n";
  EXPECT_EQ(sweep(), 3);
  EXPECT_NE(said().find(std::string(kRuns[0]) + ": cannot make the folder " + run(kRuns[0]).string() + ": "),
            std::string::npos)
      << said();
  EXPECT_EQ(read_summary(run(kRuns[2]))["status"], "done");
  EXPECT_TRUE(fs::exists(out() / "report.html"));
}

TEST_F(Sweep, the_listed_commands_do_what_the_sweep_would) {
  ASSERT_EQ(sweep({"--list"}), 0);
  std::istringstream commands(said());
  std::vector<std::string> lines;
  for (std::string line; std::getline(commands, line);) lines.push_back(line);
  ASSERT_EQ(lines.size(), 4u) << said();
  EXPECT_FALSE(fs::exists(out())) << "a list runs nothing";
  for (size_t k : {2, 3}) ASSERT_EQ(std::system((lines[k] + " >/dev/null 2>&1").c_str()), 0) << lines[k];
  ASSERT_EQ(sweep({"--report"}), 0) << said();
  EXPECT_NE(text_of(out() / "sweep.csv").find("rolling_cdt__seed_1,cdt,1,to do,"), std::string::npos);
  ASSERT_EQ(sweep({"--list"}), 0);
  EXPECT_EQ(said(), lines[0] + "\n" + lines[1] + "\n") << "only what is not done";
  EXPECT_EQ(hash_of(run(kRuns[3])), undisturbed("epsd2", "2", "0.3e-3", "0.03"));
}

}  // namespace
}  // namespace scree
