// What the runs of a sweep have left in their folders.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "runtime/report_data.h"
#include "runtime/sweep_plan.h"

namespace scree {

// "done", "failed" or "interrupted" as summary.json has it; "begun" without one; "to do" without a folder. Throws
// RunRefused if the folder's case is not the plan's.
std::string status_of(const SweepRun& run, const std::filesystem::path& folder);

// The run's summary.json; null if there is none.
ReportJson summary_in(const std::filesystem::path& folder);

// out/sweep.csv (one row for each run of the plan) and out/report.html. Throws RunError if they cannot be written.
void write_sweep_results(const SweepPlan& plan, const std::filesystem::path& out);

}  // namespace scree
