// The command `scree`.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "kernels/parallel.h"
#include "kernels/step_kernels.h"
#include "runtime/case_error.h"
#include "runtime/case_reader.h"
#include "runtime/list_check.h"
#include "runtime/render/options.h"
#include "runtime/report.h"
#include "runtime/run_folder.h"
#include "runtime/simulation.h"
#include "runtime/sweep.h"
#include "runtime/time_scales.h"

namespace {

constexpr int kDone = 0, kBadInput = 2, kFailed = 3, kInterrupted = 130;

volatile std::sig_atomic_t stop_requested = 0;
void request_stop(int) { stop_requested = 1; }

struct Arguments {
  std::string case_file, out, isa;
  std::vector<std::string> folders;
  scree::SweepOptions sweep;
  uint64_t check_lists = scree::EngineOptions{}.list_check_interval;
  std::vector<std::string> set;
  int threads = 0;
  double checkpoint_every = 0;  // s; 0: not given
  bool resume = false;
  bool force_memory = false;
  bool profile = false;
};

// results/<case>, or the next of results/<case>-2, -3, ... that is free: nothing is overwritten. To resume: the last of
// them that is there.
std::filesystem::path default_folder(const std::string& case_file, bool resume) {
  const std::filesystem::path base = std::filesystem::path("results") / std::filesystem::path(case_file).stem();
  std::filesystem::path folder = base, last = base;
  for (int k = 2; std::filesystem::exists(folder); ++k)
    last = std::exchange(folder, base.string() + fmt::format("-{}", k));
  return resume ? last : folder;
}

// A page that cannot be written takes nothing from the run.
void report_on(const std::filesystem::path& folder) {
  try {
    const std::filesystem::path page = folder / scree::kReportFile;
    scree::write_report(page, {folder});
    fmt::print("report in {}\n", std::filesystem::absolute(page).string());
  } catch (const std::exception& e) {
    fmt::print(stderr, "scree: warning: no report: {}; `scree report {}` tries again\n", e.what(), folder.string());
  }
}

int run(const Arguments& a) {
  std::vector<std::string> set = a.set;
  if (a.checkpoint_every > 0) set.push_back(fmt::format("checkpoint.interval={}", a.checkpoint_every));
  const scree::Case c = scree::read_case(a.case_file, set);
  scree::RunOptions options;
  options.out = a.out.empty() ? default_folder(a.case_file, a.resume) : std::filesystem::path(a.out);
  options.resume = a.resume;
  if (!a.resume && std::filesystem::exists(options.out) && !std::filesystem::is_empty(options.out)) {
    fmt::print(stderr,
               "scree: the results folder {} is not empty: go on with its run by --resume, name another with --out, or "
               "remove it\n",
               options.out.string());
    return kBadInput;
  }
  options.threads = a.threads;
  options.engine.isa = a.isa;
  options.engine.list_check_interval = a.check_lists;
  options.engine.profile = a.profile;
  options.ignore_memory = a.force_memory;
  options.show_progress = isatty(STDERR_FILENO);
  options.stop = &stop_requested;
  options.tell = [](const std::string& text) { fmt::print(stderr, "scree: {}\n", text); };
  std::signal(SIGINT, request_stop);
  std::signal(SIGTERM, request_stop);
  std::signal(SIGXFSZ, SIG_IGN);  // a file beyond the system's limit is an error of that file, with its name
  for (const std::string& warning : scree::time_step_warnings(c)) fmt::print(stderr, "scree: warning: {}\n", warning);

  const scree::RunResult result = scree::run_case(c, options);
  fmt::print("{}", result.profile);
  if (result.steady)
    fmt::print("steady mass flow rate {:.3f} +- {:.3f} g/s, from {:.3f} s to {:.3f} s\n", 1e3 * result.steady->rate,
               1e3 * result.steady->standard_error, result.steady->from, result.steady->to);
  else if (result.status == scree::RunStatus::done)
    fmt::print("no steady mass flow: the run has no drain, or its discharge has no plateau (see mass_flow.csv)\n");
  fmt::print("results in {}\n", std::filesystem::absolute(result.out).string());
  if (std::filesystem::exists(result.out / "summary.json")) report_on(result.out);
  if (!result.warning.empty()) fmt::print(stderr, "scree: warning: {}\n", result.warning);
  if (result.status == scree::RunStatus::failed) fmt::print(stderr, "scree: the run failed: {}\n", result.message);
  if (result.status == scree::RunStatus::interrupted)
    fmt::print(stderr, "scree: interrupted; the results so far are complete\n");
  if (result.status != scree::RunStatus::done && !result.checkpoint.empty())
    fmt::print(stderr, "scree: `scree resume {}` goes on from {}\n", result.out.string(), result.checkpoint);
  if (result.bad_input) return kBadInput;
  return result.status == scree::RunStatus::done     ? kDone
         : result.status == scree::RunStatus::failed ? kFailed
                                                     : kInterrupted;
}

int resume(Arguments a) {
  const std::filesystem::path case_file = std::filesystem::path(a.out) / "case.toml";
  if (!std::filesystem::is_regular_file(case_file)) {
    fmt::print(stderr, "scree: {} is not the results folder of a run: it has no case.toml\n", a.out);
    return kBadInput;
  }
  a.case_file = case_file.string(), a.resume = true;
  return run(a);
}

int report(const Arguments& a) {
  for (const std::string& folder : a.folders) scree::require_run_folder(folder);
  std::filesystem::path page = a.out;
  if (a.out.empty())
    page = a.folders.size() > 1 ? "comparison.html" : std::filesystem::path(a.folders[0]) / scree::kReportFile;
  scree::write_report(page, {a.folders.begin(), a.folders.end()});
  fmt::print("report in {}\n", std::filesystem::absolute(page).string());
  return kDone;
}

int sweep(Arguments a) {
  scree::SweepOptions& options = a.sweep;
  options.out = a.out;
  if (a.out.empty()) options.out = std::filesystem::path("results") / std::filesystem::path(a.case_file).stem();
  options.threads = a.threads;
  options.stop = &stop_requested;
  std::signal(SIGINT, request_stop);
  std::signal(SIGTERM, request_stop);
  const scree::SweepEnd end = scree::run_sweep(a.case_file, options);
  return end == scree::SweepEnd::done ? kDone : end == scree::SweepEnd::failed ? kFailed : kInterrupted;
}

int check(const Arguments& a) {
  const scree::Case c = scree::read_case(a.case_file, a.set);
  if (a.threads > 0) scree::set_thread_count(a.threads);
  fmt::print("{}", scree::describe_case(c));
  std::fflush(stdout);
  for (const std::string& warning : scree::time_step_warnings(c)) fmt::print(stderr, "scree: warning: {}\n", warning);
  fmt::print("{}", scree::estimate_time(c));
  return kDone;
}

int render(const Arguments& a, const scree::RenderArguments& pictures) {
  if (a.threads > 0) scree::set_thread_count(a.threads);
  std::signal(SIGXFSZ, SIG_IGN);
  scree::render_folder(pictures, [](const std::string& text) { fmt::print("{}\n", text); });
  return kDone;
}

void add_threads_option(CLI::App& command, Arguments& a) {
  command.add_option("--threads", a.threads, "threads (default: all processors); the results do not depend on it")
      ->check(CLI::Range(1, 4096));
}

void add_case_options(CLI::App& command, Arguments& a) {
  command.add_option("CASE", a.case_file, "the case file (TOML)")->required();
  command.add_option(
      "--set", a.set,
      "change a key of the case: key.path=value, e.g. "
      "lattice.fibre_diameter=1.36e-3,\nmaterial.steel.youngs_modulus=1e8, contact.rolling=cdt; may be repeated");
  add_threads_option(command, a);
}

CLI::App& add_report(CLI::App& app, Arguments& a) {
  CLI::App& command = *app.add_subcommand("report", "make a run's report.html again, or compare several runs");
  command.add_option("DIR", a.folders, "results folders")->required();
  command.add_option("--out", a.out, "the page (default: DIR/report.html of one run, comparison.html of several)");
  return command;
}

CLI::App& add_sweep(CLI::App& app, Arguments& a) {
  CLI::App& command = *app.add_subcommand("sweep", "run a table of parameters; repeat it to go on");
  command.add_option("SWEEP", a.case_file, "the sweep file (TOML): see cases/olhx/sweep_porosity.toml")->required();
  command.add_option("--out", a.out, "folder of the sweep (default: results/<sweep>)");
  command.add_option("--jobs", a.sweep.jobs, "runs at a time, which share the threads")->check(CLI::Range(1, 4096));
  command.add_flag("--list", a.sweep.list, "print the commands of the runs to do, one per line, for a cluster's array");
  command.add_flag("--report", a.sweep.report_only, "only write sweep.csv and report.html of what is there");
  add_threads_option(command, a);
  return command;
}

void add_run_options(CLI::App& command, Arguments& a) {
  command.add_option("--isa", a.isa, "instruction set of the kernels (default: the best this machine has)")
      ->check(CLI::IsMember(scree::available_isas()));
  command
      .add_option("--checkpoint-every", a.checkpoint_every,
                  "wall-clock seconds between checkpoints (default: the case's checkpoint.interval, 600)")
      ->check(CLI::PositiveNumber);
  command.add_option("--check-lists", a.check_lists,
                     fmt::format("steps between proofs by a fresh search that no contact is missing from the lists "
                                 "(default {}; 0: none; 1: every step, for finding errors of the program); up to {} "
                                 "particles by brute force, every pair and (of not too many) every fibre and wall",
                                 scree::EngineOptions{}.list_check_interval, scree::kBruteForceUpTo));
  command.add_flag("--force-memory", a.force_memory, "run though the estimate says that memory does not suffice");
  command.add_flag("--profile", a.profile, "print at the end where the time went, part by part of the step");
}

int command_line(int argc, char** argv) {
  CLI::App app{
      "Scree: discrete element simulation of granular flow.\n\n"
      "A case file says what is simulated: materials, particles, walls and fibres, and the stages\n"
      "of the run (fill, settle, open a lid, drain). Start from a commented one:\n"
      "  scree run cases/olhx/demo.toml          the Octet-lattice heat exchanger, small\n"
      "  scree check cases/olhx/paper_088.toml   what would run, how long, how much memory\n"
      "  ls cases/examples                       one example per feature\n"};
  app.footer(
      "Results: report.html (open it in a browser), mass_flow.csv, meters.csv, summary.json, pictures/, fields/\n"
      "(ParaView), residence.csv, retained.csv, particles.vtp (ParaView), case.toml, run.log.\n"
      "A run that was interrupted, killed or failed goes on to the same bits:  scree resume DIR\n"
      "Exit codes: 0 done, 2 bad input, 3 the run failed, 130 interrupted (Ctrl-C ends a run cleanly).");
  app.set_version_flag("--version", "scree 0.1.0");
  app.require_subcommand(1);
  Arguments a;
  CLI::App& run_command = *app.add_subcommand("run", "run a case");
  add_case_options(run_command, a);
  run_command.add_option("--out", a.out, "results folder (default: results/<case>, or the next free name)");
  run_command.add_flag("--resume", a.resume,
                       "go on from the newest checkpoint in the results folder, if it has one\n(without --out: the "
                       "last of results/<case>, results/<case>-2, ... before the first that is free)");
  add_run_options(run_command, a);
  CLI::App& resume_command = *app.add_subcommand("resume", "go on with an unfinished run from its newest checkpoint");
  resume_command.add_option("DIR", a.out, "its results folder")->required();
  add_threads_option(resume_command, a);
  add_run_options(resume_command, a);
  CLI::App& check_command = *app.add_subcommand("check", "validate a case and print what would run");
  add_case_options(check_command, a);
  scree::RenderArguments pictures;
  CLI::App& render_command = scree::add_render_command(app, pictures);
  add_threads_option(render_command, a);
  CLI::App &report_command = add_report(app, a), &sweep_command = add_sweep(app, a);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    const int code = app.exit(e);
    return code == 0 ? kDone : kBadInput;
  }
  try {
    if (render_command.parsed()) return render(a, pictures);
    if (report_command.parsed()) return report(a);
    if (sweep_command.parsed()) return sweep(a);
    return run_command.parsed() ? run(a) : resume_command.parsed() ? resume(a) : check(a);
  } catch (const scree::CaseError& e) {
    fmt::print(stderr, "scree: {}\n", e.what());
    return kBadInput;
  } catch (const scree::RunRefused& e) {
    fmt::print(stderr, "scree: {}\n", e.what());
    return kBadInput;
  } catch (const std::invalid_argument& e) {
    fmt::print(stderr, "scree: {}\n", e.what());
    return kBadInput;
  }
}

}  // namespace

int main(int argc, char** argv) {
  const char* why = "an error of unknown kind";
  try {
    return command_line(argc, argv);
  } catch (const std::bad_alloc&) {
    why = "out of memory";  // with nothing allocated for saying so
  } catch (const std::exception& e) {
    std::fprintf(stderr, "scree: %s\n", e.what());
    return kFailed;
  } catch (...) {
  }
  std::fprintf(stderr, "scree: %s\n", why);
  return kFailed;
}
