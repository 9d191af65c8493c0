#include "runtime/touch_maps.h"

#include <algorithm>
#include <cmath>

#include "runtime/during.h"
#include "runtime/timer.h"
#include "runtime/touch_files.h"
#include "runtime/touch_numbers.h"

namespace scree {

void add_touches(const TouchSurface& surface, std::span<const ContactState> contacts, TouchRecord& record) {
  std::vector<size_t> touched;
  for (const ContactState& k : contacts) {
    if (!k.with_solid || !surface.is_mapped(k.j)) continue;
    const size_t cell = surface.cell_of(k.j, k.point);
    if (cell == TouchSurface::kNone) {
      ++record.elsewhere;
      continue;
    }
    TouchSums& sums = record.cells[cell];
    const double normal = dot(k.force, k.normal);
    ++sums.contacts;
    sums.force += normal;
    sums.rubbing -= dot(k.force - normal * k.normal, k.slip);
    touched.push_back(cell);
  }
  std::ranges::sort(touched);
  touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
  for (const size_t cell : touched) ++record.cells[cell].touched;
  ++record.looks;
}

TouchMaps::TouchMaps(const Case& c, double dt)
    : during_(c.output.touch.during), schedule_(c.output.touch.moments, dt), surface_(c) {
  record_.cells.resize(surface_.size());
}

void TouchMaps::look(const RunView& run) {
  const uint64_t step = run.engine.counters().steps;
  if (step == record_.last_step || !counts(during_, run)) return;
  Timer t(record_.seconds);
  record_.last_step = step;
  if (record_.looks == 0) record_.from = run.engine.time();
  record_.to = run.engine.time();
  add_touches(surface_, run.engine.contacts(Engine::Contacts::with_solids), record_);
}

void TouchMaps::finish(const RunView& run) {
  summary_ = touch_summary(run.c, surface_, record_);
  if (record_.looks > 0) write_touch(run.out, run.c, surface_, record_);
}

}  // namespace scree
