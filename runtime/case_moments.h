// When to look, as a case file says it: `interval`, `times`, `stage_ends`, `window`.
#pragma once

#include "runtime/case_table.h"
#include "runtime/schedule.h"

namespace scree {

// Reads the keys below out of `table`:
//   interval = 0.01        # s between looks
//   times = [0.1, 0.25]    # s since the run began
//   stage_ends = true      # at the end of each stage
//   window = [0.1, 0.5]    # s: intervals count from the first to the second
// Without `interval` and `times`, stage_ends is on unless `fallback` says otherwise.
Moments read_moments(TableReader& table, const Moments& fallback = {});

}  // namespace scree
