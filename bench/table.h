// The table that bench/run prints: a line for each benchmark, as soon as it is done.
#pragma once

#include <benchmark/benchmark.h>

namespace scree::bench {

class TableReporter : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context& context) override;
  void ReportRuns(const std::vector<Run>& runs) override;
};

}  // namespace scree::bench
