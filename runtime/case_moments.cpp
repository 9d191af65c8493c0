#include "runtime/case_moments.h"

#include <fmt/format.h>

namespace scree {

Moments read_moments(TableReader& table, const Moments& fallback) {
  Moments m = fallback;
  if (table.has("interval") || fallback.interval > 0)
    m.interval = fallback.interval > 0 ? table.number("interval", kDuration, fallback.interval)
                                       : table.number("interval", kDuration);
  if (table.has("times")) {
    m.times = table.numbers("times", between(0, 1e6, "s"), 0);
    std::ranges::sort(m.times);
  }
  const bool nothing_else = m.interval == 0 && m.times.empty();
  m.stage_ends = table.flag("stage_ends", fallback.stage_ends || nothing_else);
  if (table.has("window")) {
    const std::vector<double> window = table.numbers("window", between(0, 1e6, "s"), 2);
    if (window[1] <= window[0])
      table.fail("window",
                 fmt::format("{} ends before it begins, must be [from, to] with from < to, s", table.shown("window")));
    m.from = window[0], m.to = window[1];
  }
  return m;
}

}  // namespace scree
