// Runs of the command `scree` that something befalls: processes, and what an undisturbed run of the same case leaves.
#pragma once

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <chrono>
#include <csignal>
#include <functional>
#include <thread>

#include "tests/cases/every_stage.h"

namespace scree {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

// A process of the command `scree`; what it says goes to a file.
class Process {
 public:
  // `before` runs in the new process before the command does.
  Process(const std::vector<std::string>& arguments, const fs::path& said, const std::function<void()>& before = {})
      : said_(said) {
    std::vector<char*> argv{const_cast<char*>(SCREE_COMMAND)};
    for (const std::string& a : arguments) argv.push_back(const_cast<char*>(a.c_str()));
    argv.push_back(nullptr);
    pid_ = fork();
    if (pid_ != 0) return;
    const int file = open(said.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
    dup2(file, STDOUT_FILENO), dup2(file, STDERR_FILENO);
    if (before) before();
    execv(SCREE_COMMAND, argv.data());
    _exit(127);
  }
  ~Process() {
    if (pid_ > 0) send(SIGKILL), wait();
  }
  Process(const Process&) = delete;

  void send(int signal) const { kill(pid_, signal); }
  int wait() {  // exit code, or minus the signal
    int status = 0;
    waitpid(pid_, &status, 0);
    pid_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }
  std::string said() const { return text_of(said_); }

 private:
  fs::path said_;
  pid_t pid_;
};

class Faults : public ::testing::Test {
 protected:
  Faults() : case_(write_every_stage(folder_.path())) {}

  fs::path path(const std::string& name) const { return folder_.path() / name; }
  std::vector<std::string> run_command(const fs::path& out, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> a{"run", case_, "--out", out.string()};
    a.insert(a.end(), more.begin(), more.end());
    return a;
  }
  int execute(const std::vector<std::string>& arguments, const std::function<void()>& before = {}) {
    Process p(arguments, path("said"), before);
    const int code = p.wait();
    said_ = p.said();
    return code;
  }
  // Results of a run that nothing befell.
  const fs::path& undisturbed() {
    static const TemporaryFolder folder;
    static const fs::path out = [&] {
      RunOptions options;
      options.out = folder.path() / "undisturbed";
      EXPECT_EQ(run_case(read_case(case_, {"checkpoint.keep=1000"}), options).status, RunStatus::done);
      return options.out;
    }();
    return out;
  }
  void expect_resumes(const fs::path& out) {
    ASSERT_EQ(execute({"resume", out.string()}), 0) << said_;
    expect_undisturbed(out);
  }
  void expect_undisturbed(const fs::path& out) { expect_same_results(out, undisturbed()); }

  TemporaryFolder folder_;
  std::string case_, said_;
};

inline void wait_until(const auto& condition) {
  for (int k = 0; k < 20000 && !condition(); ++k) std::this_thread::sleep_for(1ms);
}

}  // namespace scree
