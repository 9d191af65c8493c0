// What is under [output]: [output.fields] and [output.residence] here, averages and touch maps in case_averages.cpp.
#include <algorithm>
#include <cmath>

#include "runtime/case_moments.h"
#include "runtime/case_sections.h"
#include "runtime/case_size.h"
#include "runtime/particle_fields.h"

namespace scree {

namespace {

constexpr double kMostFrames = 1e5;

void check_frames(const TableReader& t, const Case& c, const Moments& m) {
  if (m.interval == 0) return;
  const double frames = (std::min(longest_time(c), m.to) - m.from) / m.interval;
  if (frames <= kMostFrames) return;
  t.fail("interval", fmt::format("{} s makes {:.3g} frames in the stages' {:.4g} s, must be at most {:g}: a longer "
                                 "interval, or a window",
                                 t.shown("interval"), frames, longest_time(c), kMostFrames));
}

void read_fields(TableReader t, Case& c) {
  FieldSettings& fields = c.output.fields;
  fields.moments = read_moments(t);
  const std::vector<std::string> known = particle_field_names();
  for (const std::string& name : t.texts("write", known)) {
    t.index_of("write", name, "field", known);
    fields.write.push_back(name);
  }
  fields.solid = t.flag("solid", fields.solid);
  t.finish();
  check_frames(t, c, fields.moments);
}

void read_residence(TableReader t, Case& c) {
  ResidenceSettings& r = c.output.residence;
  const Bounds& section = c.fibres.section;
  const bool layer = c.fibres.count > 0 && section.max.z > section.min.z;
  const bool drains =
      std::ranges::any_of(c.stages, [](const Stage& s) { return std::holds_alternative<DrainStage>(s.action); });
  r.enabled = t.flag("enabled", (layer && drains) || t.has("entry") || t.has("exit"));
  for (const char* key : {"interval", "entry", "exit", "bin"})
    if (!r.enabled && t.has(key)) t.fail(key, fmt::format("{} has no effect with enabled = false", t.shown(key)));
  if (r.enabled) {
    r.interval = t.number("interval", kDuration, r.interval);
    r.entry = layer ? t.number("entry", kPosition, section.max.z) : t.number("entry", kPosition);
    r.exit = layer ? t.number("exit", kPosition, section.min.z) : t.number("exit", kPosition);
    r.bin = t.number("bin", between(0, 1e6, "s (0: chosen to fit)"), r.bin);
    if (r.exit >= r.entry)
      t.fail("exit", fmt::format("{} is not below entry = {}, m: grains go down", t.shown("exit"), t.shown("entry")));
  }
  t.finish();
}

}  // namespace

void read_observers(TableReader& top, Case& c) {
  TableReader output = top.table("output");
  read_fields(output.table("fields"), c);
  read_residence(output.table("residence"), c);
  read_averages(output, c);
  read_touch(output, c);
}

}  // namespace scree
