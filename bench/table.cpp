#include "bench/table.h"

#include <string>

#include <fmt/format.h>

namespace scree::bench {
namespace {

using Run = benchmark::BenchmarkReporter::Run;

double counter(const Run& run, const char* name) {
  const auto found = run.counters.find(name);
  return found == run.counters.end() ? 0 : found->second.value;
}

// What a benchmark is about: the first of these rates that it has.
std::string main_rate(const Run& run) {
  for (const char* name :
       {"particle_steps/s", "particles/s", "contacts/s", "keys/s", "queries/s", "grains/s", "rows/s"})
    if (const double rate = counter(run, name); rate > 0) return fmt::format("{:9.4g} M {:<16}", rate / 1e6, name);
  return fmt::format("{:28}", "");
}

std::string step_columns(const Run& run) {
  if (counter(run, "particle_steps/s") <= 0) return fmt::format("{:50}", "");
  return fmt::format("{:9.4g} {:9.0f} {:9.1f} {:9.0f} {:9.0f}  ", counter(run, "contacts/s") / 1e6,
                     counter(run, "bytes_per_particle_step"), 100 * counter(run, "copy_share"),
                     counter(run, "bytes_held_per_particle"), counter(run, "peak_of_rebuild_per_particle"));
}

}  // namespace

bool TableReporter::ReportContext(const Context&) {
  fmt::print("{:<44} {:>10}  {:>9}   {:<16} {:>9} {:>9} {:>9} {:>9} {:>9}   {}\n", "benchmark", "ms", "rate", "of",
             "M cont./s", "B/p.step", "% of copy", "B held", "B peak", "hash");
  return true;
}

void TableReporter::ReportRuns(const std::vector<Run>& runs) {
  for (const Run& run : runs) {
    std::string name = run.run_name.function_name;
    if (!run.run_name.args.empty()) name += "/" + run.run_name.args;
    if (run.run_type == Run::RT_Aggregate) name += " " + run.aggregate_name;
    const double seconds = run.GetAdjustedRealTime() / benchmark::GetTimeUnitMultiplier(run.time_unit);
    fmt::print("{:<44} {:>10.4g}  {} {}{}\n", name, 1e3 * seconds, main_rate(run), step_columns(run), run.report_label);
  }
  std::fflush(stdout);
}

}  // namespace scree::bench
