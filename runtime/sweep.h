// Runs a sweep: every run of its plan as a process of its own, in SWEEP_OUT/<name>, then SWEEP_OUT/sweep.csv and
// SWEEP_OUT/report.html.
#pragma once

#include <csignal>
#include <filesystem>
#include <string>

namespace scree {

struct SweepOptions {
  std::filesystem::path out;
  std::filesystem::path command;                     // the program `scree`; empty: this one
  int jobs = 1;                                      // runs at a time
  int threads = 0;                                   // of all of them together; 0: all processors
  bool list = false;                                 // print the commands of the runs that are not done, run nothing
  bool report_only = false;                          // write sweep.csv and report.html of what is there, run nothing
  const volatile std::sig_atomic_t* stop = nullptr;  // set from outside: the runs save their states and end
};

enum class SweepEnd { done, failed, interrupted };  // failed: a run did; the others went on

// Runs that are done are skipped, others begin or go on from their newest checkpoint. Throws CaseError for a wrong
// sweep file, RunRefused for a folder in use or with a run whose case is not what the sweep file says now.
SweepEnd run_sweep(const std::string& sweep_file, const SweepOptions& options);

}  // namespace scree
