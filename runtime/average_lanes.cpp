#include "runtime/average_lanes.h"

#include <algorithm>
#include <cmath>

#include "geometry/bounds.h"

namespace scree {

namespace {

// The heights between which lanes are looked for.
std::pair<double, double> heights_of(const Case& c, const CoarseGrid& grid) {
  const double bottom = grid.origin.z, top = grid.origin.z + grid.cells[2] * grid.spacing.z;
  const Bounds& section = c.fibres.section;
  const bool has_section = c.fibres.count > 0 && volume_of(section) > 0;
  if (!has_section || section.min.z >= top || section.max.z <= bottom) return {bottom, top};
  return {std::max(bottom, section.min.z), std::min(top, section.max.z)};
}

}  // namespace

std::vector<Lane> lanes_of(const CoarseGrid& grid, const AverageFields& f, double from, double to) {
  const size_t layer = size_t(grid.cells[0]) * grid.cells[1];
  const double axis_x = grid.origin.x + 0.5 * grid.cells[0] * grid.spacing.x;
  const double axis_y = grid.origin.y + 0.5 * grid.cells[1] * grid.spacing.y;
  std::vector<Lane> lanes;
  for (size_t first = 0; first < grid.size(); first += layer) {
    const double z = grid.centre(first).z;
    if (z < from || z > to) continue;
    double flux = 0, free = 0;
    size_t most = first;
    for (size_t cell = first; cell < first + layer; ++cell) {
      flux -= f.mass_flux[cell].z, free += f.free_share[cell];
      if (f.mass_flux[cell].z < f.mass_flux[most].z) most = cell;
    }
    if (!(flux > 0) || !(free > 0)) continue;
    const Vec3 at = grid.centre(most);
    lanes.push_back({z, -f.mass_flux[most].z * free / flux, at.x, at.y, std::hypot(at.x - axis_x, at.y - axis_y)});
  }
  return lanes;
}

nlohmann::json lane_summary(const Case& c, const CoarseGrid& grid, const AverageFields& fields) {
  const auto [from, to] = heights_of(c, grid);
  const std::vector<Lane> lanes = lanes_of(grid, fields, from, to);
  if (lanes.empty()) return nullptr;
  const auto list = [&](double Lane::*what) {
    std::vector<double> values;
    for (const Lane& lane : lanes) values.push_back(lane.*what);
    return values;
  };
  const auto range = [&](double Lane::*what) {
    const std::vector<double> values = list(what);
    double sum = 0;
    for (const double v : values) sum += v;
    return nlohmann::json{{"mean", sum / static_cast<double>(values.size())},
                          {"least", *std::ranges::min_element(values)},
                          {"most", *std::ranges::max_element(values)}};
  };
  return {{"peak_over_mean", range(&Lane::peak_over_mean)},
          {"distance_from_axis_m", range(&Lane::from_axis)},
          {"layers",
           {{"z_m", list(&Lane::z)},
            {"peak_over_mean", list(&Lane::peak_over_mean)},
            {"x_m", list(&Lane::x)},
            {"y_m", list(&Lane::y)},
            {"distance_from_axis_m", list(&Lane::from_axis)}}}};
}

}  // namespace scree
