// Whether a look counts: some observers count while a drain stage runs, or in its steady window.
#pragma once

#include "runtime/observer.h"

namespace scree {

inline bool counts(During during, const RunView& run) {
  if (during == During::always) return true;
  for (const Stage& s : run.c.stages) {
    if (s.name != run.stage || !std::holds_alternative<DrainStage>(s.action)) continue;
    const double t = run.engine.time() - run.stage_start, slack = 0.5 * run.engine.dt();
    const OutputSettings& o = run.c.output;
    return during == During::drain || (t >= o.steady_from - slack && t <= o.steady_to + slack);
  }
  return false;
}

}  // namespace scree
