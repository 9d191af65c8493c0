#include "runtime/touch_numbers.h"

#include <cmath>

#include "runtime/results.h"

namespace scree {

namespace {

constexpr auto kAll = [](uint32_t, uint32_t) { return true; };

nlohmann::json text_of(const TouchMeans& m) {
  if (m.area == 0) return nullptr;
  return {{"exposed_area_m2", m.area},
          {"dead_share", m.dead_share()},
          {"out_of_reach_share", m.out_of_reach / m.area},
          {"touched_share", m.touched_share()},
          {"contacts_per_m2", m.contact_density()},
          {"mean_normal_force_N", m.mean_force()},
          {"pressure_Pa", m.pressure()},
          {"sliding_work_W_per_m2", m.rubbing_per_area()}};
}

}  // namespace

void TouchMeans::add(double cell_area, TouchState state, const TouchSums& sums) {
  if (state == TouchState::hidden) return;
  area += cell_area;
  if (sums.touched == 0) dead += cell_area;
  if (state == TouchState::out_of_reach) out_of_reach += cell_area;
  if (looks > 0) touched += cell_area * static_cast<double>(sums.touched) / static_cast<double>(looks);
  contacts += static_cast<double>(sums.contacts), force += sums.force, rubbing += sums.rubbing;
}

void TouchMeans::add(const TouchMeans& o) {
  area += o.area, dead += o.dead, out_of_reach += o.out_of_reach, touched += o.touched;
  contacts += o.contacts, force += o.force, rubbing += o.rubbing, looks = o.looks;
}

TouchMeans means_of(const TouchPatch& patch, const TouchSurface& surface, const TouchRecord& record,
                    const std::function<bool(uint32_t, uint32_t)>& pick) {
  TouchMeans means;
  means.looks = record.looks;
  for (uint32_t row = 0; row < patch.rows; ++row)
    for (uint32_t column = 0; column < patch.columns; ++column) {
      const size_t cell = patch.first + size_t(row) * patch.columns + column;
      if (pick(row, column)) means.add(patch.cell_area(), surface.states()[cell], record.cells[cell]);
    }
  return means;
}

bool looks_up(const TouchPatch& fibre, uint32_t column) { return std::cos(fibre.angle(column)) > 0; }

nlohmann::json touch_summary(const Case& c, const TouchSurface& surface, const TouchRecord& record) {
  if (record.looks == 0) return {{"looks", 0}};  // nothing is known to be dead
  TouchMeans fibres, upper, lower;
  std::vector<TouchMeans> walls(c.solid.walls.size());
  for (const TouchPatch& p : surface.patches()) {
    if (!p.fibre) {
      walls[c.solid.primitives[p.primitive].wall].add(means_of(p, surface, record, kAll));
      continue;
    }
    fibres.add(means_of(p, surface, record, kAll));
    upper.add(means_of(p, surface, record, [&](uint32_t, uint32_t column) { return looks_up(p, column); }));
    lower.add(means_of(p, surface, record, [&](uint32_t, uint32_t column) { return !looks_up(p, column); }));
  }
  nlohmann::json j = {{"looks", record.looks},
                      {"seconds", record.seconds},
                      {"window_s", {record.from, record.to}},
                      {"contacts_on_no_cell", record.elsewhere}};
  if (fibres.area > 0)
    j["fibres"] = text_of(fibres), j["fibres"]["upper_half"] = text_of(upper),
    j["fibres"]["lower_half"] = text_of(lower);
  for (const uint32_t w : c.output.touch.walls) j["walls"][c.solid.walls[w]] = text_of(walls[w]);
  return j;
}

void write_touch_csv(const std::filesystem::path& path, const TouchSurface& surface, const TouchRecord& record) {
  CsvWriter csv(path, {"primitive", "is_fibre", "x_m", "y_m", "z_m", "end_x_m", "end_y_m", "end_z_m", "exposed_area_m2",
                       "dead_share", "touched_share", "upper_touched_share", "lower_touched_share", "contacts_per_m2",
                       "mean_normal_force_N", "sliding_work_W_per_m2"});
  for (const TouchPatch& p : surface.patches()) {
    const TouchMeans all = means_of(p, surface, record, kAll);
    const auto half = [&](bool up) {
      return p.fibre
                 ? means_of(p, surface, record, [&](uint32_t, uint32_t column) { return looks_up(p, column) == up; })
                       .touched_share()
                 : std::nan("");
    };
    const Vec3 end = p.fibre ? p.origin + p.length * p.along : p.origin + p.length * p.along + p.width * p.across;
    csv.row(std::array{static_cast<double>(p.primitive), p.fibre ? 1.0 : 0.0, p.origin.x, p.origin.y, p.origin.z, end.x,
                       end.y, end.z, all.area, all.dead_share(), all.touched_share(), half(true), half(false),
                       all.contact_density(), all.mean_force(), all.rubbing_per_area()});
  }
}

}  // namespace scree
