// Runs a case: its stages one after the other, what is measured on the way, and the results folder.
#pragma once

#include <csignal>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "runtime/engine.h"
#include "runtime/mass_flow.h"

namespace scree {

struct RunOptions {
  std::filesystem::path out;
  int threads = 0;             // 0: all processors
  bool show_progress = false;  // on a terminal
  EngineOptions engine;
  const volatile std::sig_atomic_t* stop = nullptr;  // set from outside (Ctrl-C): the run ends with what it has
  bool ignore_memory = false;                        // run though the estimate says that it does not fit
  bool resume = false;                               // go on from the newest usable checkpoint in `out`
  std::function<void(const std::string&)> tell;      // what a user should read at once; it is in run.log, too
};

enum class RunStatus { done, interrupted, failed };

struct RunResult {
  RunStatus status = RunStatus::done;
  std::string message;     // why it failed
  bool bad_input = false;  // it failed by a file that a stage reads
  std::string warning;     // the ledger does not close; empty: it does, or there is none
  std::optional<SteadyFlow> steady;
  std::filesystem::path out;
  std::string profile;     // a table, when EngineOptions::profile is set
  std::string checkpoint;  // the newest that the run can be gone on from; empty: none
};

// Writes run.log, case.toml, mass_flow.csv, meters.csv (when the case has meters), particles.vtp, summary.json into
// options.out, whatever the end, checkpoints on the way, and failure.vtp, the particles round the place, when a check
// stopped the run. A run that was resumed leaves the same as one that was never interrupted. Throws CaseError for a
// case that cannot start, before anything is written if it needs more memory than there is, RunRefused
// (runtime/run_folder.h) when the folder is in use or holds nothing that can be gone on from. Once it has begun a
// failed run is a result, whatever failed it, with a summary and a checkpoint where they can be written.
RunResult run_case(const Case& c, const RunOptions& options);

// What `scree check` prints: what will run, its time scales, memory (runtime/describe_case.cpp).
std::string describe_case(const Case& c);
// And how long it takes at most, from the speed of a small bed that is run now for half a second.
std::string estimate_time(const Case& c);

}  // namespace scree
