#include "runtime/sweep.h"

#include <algorithm>
#include <fstream>
#include <thread>

#include <fmt/format.h>

#include "kernels/parallel.h"
#include "runtime/child_process.h"
#include "runtime/engine.h"
#include "runtime/progress.h"
#include "runtime/report.h"
#include "runtime/run_folder.h"
#include "runtime/sweep_results.h"

namespace scree {

namespace {

namespace fs = std::filesystem;

constexpr const char* kConsole = "console.log";        // what a run says, in its folder
constexpr int kInterrupted = 130;                      // exit code of a run that was asked to stop
constexpr auto kLook = std::chrono::milliseconds(50);  // between looks at the processes

struct Job {
  const SweepRun* run;
  fs::path folder;
  std::vector<std::string> arguments;
};

fs::path command_of(const SweepOptions& options) {
  return options.command.empty() ? fs::read_symlink("/proc/self/exe") : options.command;
}

// The runs that are not done, in the plan's order. Throws RunRefused if one of the folders has another case.
std::vector<Job> open_jobs(const SweepPlan& plan, const SweepOptions& options) {
  std::vector<Job> jobs;
  for (const SweepRun& run : plan.runs) {
    const fs::path folder = fs::absolute(options.out).lexically_normal() / run.name;
    if (status_of(run, folder) != "done") jobs.push_back({&run, folder, {}});
  }
  const int total = options.threads > 0 ? options.threads : thread_count();
  const int at_a_time = std::clamp(options.jobs, 1, std::max<int>(1, static_cast<int>(jobs.size())));
  for (Job& job : jobs) {
    job.arguments = {
        command_of(options).string(), "run",      plan.case_file, "--out",
        job.folder.string(),          "--resume", "--threads",    std::to_string(std::max(1, total / at_a_time))};
    for (const std::string& set : job.run->set) job.arguments.insert(job.arguments.end(), {"--set", set});
  }
  return jobs;
}

std::string shell_quoted(const std::string& word) {
  constexpr const char* kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789/._+=:,-";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? "'\\''" : std::string(1, c);
  return quoted + "'";
}

void print_list(const std::vector<Job>& jobs) {
  for (const Job& job : jobs) {
    std::vector<std::string> words;
    for (const std::string& word : job.arguments) words.push_back(shell_quoted(word));
    fmt::print("{}\n", fmt::join(words, " "));
  }
}

// The last that a run said, which is why it ended as it did.
std::string last_line(const fs::path& path) {
  std::ifstream stream(path);
  std::string last;
  for (std::string line; std::getline(stream, line);)
    if (!line.empty()) last = line;
  return last;
}

// One line about a run that has ended.
std::string told(const Job& job, int exit_code) {
  const ReportJson s = summary_in(job.folder);
  const auto number = [&](const char* key) {
    return s.is_object() && s.contains(key) && s[key].is_number() ? std::optional(s[key].get<double>()) : std::nullopt;
  };
  if (exit_code == kInterrupted) return "interrupted: a repeat of the sweep goes on";
  if (exit_code != 0)
    return fmt::format("ended with code {}: {} ({})", exit_code, last_line(job.folder / kConsole),
                       (job.folder / kConsole).string());
  const auto rate = number("steady_mass_flow_kg_per_s"), error = number("steady_mass_flow_standard_error_kg_per_s"),
             wall = number("wall_time_s");
  const std::string time = wall ? fmt::format(" ({})", duration_text(*wall)) : "";
  if (!rate) return "no steady mass flow" + time;
  return fmt::format("{:.3f} +- {:.3f} g/s{}", 1e3 * *rate, 1e3 * error.value_or(0), time);
}

// Runs jobs, so many at a time, until all have ended or a stop was asked for.
class JobQueue {
 public:
  JobQueue(const std::vector<Job>& jobs, size_t skipped, const SweepOptions& options)
      : jobs_(jobs), skipped_(skipped), options_(options) {}

  SweepEnd run() {
    while (next_ < jobs_.size() || !running_.empty()) {
      if (options_.stop && *options_.stop) stop();
      while (next_ < jobs_.size() && running_.size() < static_cast<size_t>(options_.jobs)) start(jobs_[next_++]);
      std::erase_if(running_, [&](Running& r) { return has_ended(r); });
      std::this_thread::sleep_for(kLook);
    }
    return stopped_ ? SweepEnd::interrupted : failed_ ? SweepEnd::failed : SweepEnd::done;
  }

 private:
  struct Running {
    const Job* job;
    ChildProcess process;
  };

  void start(const Job& job) {
    try {
      std::error_code error;
      fs::create_directories(job.folder, error);
      if (error) throw RunError(fmt::format("cannot make the folder {}: {}", job.folder.string(), error.message()));
      running_.push_back({&job, ChildProcess(job.arguments, job.folder / kConsole)});
    } catch (const RunError& e) {  // the others may have room
      failed_ = true;
      tell(job, e.what());
    }
  }
  void stop() {  // nothing new begins; what runs saves its state
    if (!stopped_)
      for (Running& r : running_) r.process.ask_to_stop();
    stopped_ = true, next_ = jobs_.size();
  }
  bool has_ended(Running& r) {
    const std::optional<int> code = r.process.poll();
    if (!code) return false;
    failed_ = failed_ || *code != 0;
    tell(*r.job, told(*r.job, *code));
    return true;
  }
  void tell(const Job& job, const std::string& what) {
    fmt::print("[{}/{}] {}: {}\n", skipped_ + ++ended_, skipped_ + jobs_.size(), job.run->name, what);
    std::fflush(stdout);
  }

  const std::vector<Job>& jobs_;
  size_t skipped_, next_ = 0, ended_ = 0;
  const SweepOptions& options_;
  std::vector<Running> running_;
  bool stopped_ = false, failed_ = false;
};

}  // namespace

SweepEnd run_sweep(const std::string& sweep_file, const SweepOptions& options) {
  const SweepPlan plan = read_sweep(sweep_file);
  const std::vector<Job> jobs = open_jobs(plan, options);
  if (options.list) {
    print_list(jobs);
    return SweepEnd::done;
  }
  const RunFolder folder(options.out);
  SweepEnd end = SweepEnd::done;
  if (!options.report_only) {
    const size_t skipped = plan.runs.size() - jobs.size();
    fmt::print("{} runs, {} of them done already\n", plan.runs.size(), skipped);
    std::fflush(stdout);
    end = JobQueue(jobs, skipped, options).run();
  }
  write_sweep_results(plan, options.out);
  fmt::print("report in {}\n", fs::absolute(options.out / kReportFile).string());
  return end;
}

}  // namespace scree
