// Where a run's time went, part by part of the step: `scree run --profile`.
#pragma once

#include <string>
#include <vector>

#include "runtime/engine.h"

namespace scree {

struct ProfileLine {
  std::string part;
  double seconds = 0;  // wall-clock, of all threads together divided by their number
};

// The parts in the order of the step, and what is left of `wall_seconds`. The engine ran with EngineOptions::profile.
std::vector<ProfileLine> profile_of(const EngineCounters& counters, int threads, double wall_seconds);

// As a table: seconds, share of the whole, nanoseconds of wall-clock time per particle and step.
std::string profile_table(const std::vector<ProfileLine>& lines, uint64_t particle_steps);

}  // namespace scree
