#include "runtime/run_state.h"

#include <algorithm>
#include <cmath>

#include "runtime/state_archive.h"

namespace scree {

void require_sound(const RunState& state, const Case& c) {
  require_state(state.stage < c.stages.size() || (state.stage == c.stages.size() && !state.begun),
                "it is in a stage that the case does not have");
  require_state(state.records.size() == state.stage + (state.begun ? 1 : 0), "its stages are not counted right");
  double last = -1;
  for (const FlowSample& s : state.samples) {
    require_state(s.time > last && s.discharged.size() == c.outlets.size() && std::isfinite(s.total()),
                  "its rows of mass flow are out of order");
    last = s.time;
  }
  const size_t columns = c.meters.empty() ? 0 : 1 + c.meters.size();
  require_state(columns == 0 ? state.meter_rows.empty() : state.meter_rows.size() % columns == 0,
                "its rows of meters are torn");
}

}  // namespace scree
