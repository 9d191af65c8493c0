// The time step held against the case's time scales.
#pragma once

#include <string>
#include <vector>

#include "runtime/case.h"

namespace scree {

struct TimeScales {
  double step = 0;      // s
  double rayleigh = 0;  // s, smallest over particles
  double hertz = 0;     // s, at `speed`
  double speed = 0;     // m/s, free fall through the domain: an upper bound for what gravity drives
};

TimeScales time_scales(const Case& c);

// Above 0.3 of the Rayleigh time. (The reader refuses more than 0.5 unless the case says [time] allow_large_step.)
std::vector<std::string> time_step_warnings(const Case& c);

}  // namespace scree
