#include "runtime/average_grid.h"

#include <algorithm>
#include <cmath>

#include "geometry/bounds.h"

namespace scree {

namespace {

constexpr double kBytesPerCell = 8 * (kGrainValues + kStressValues) + 150;  // the sums; the fields, while written

int cells_along(double length, double spacing) {
  return static_cast<int>(std::clamp(std::round(length / spacing), 1.0, 1e9));
}

}  // namespace

CoarseGrid grid_of(const AverageSettings& average, const Case& c) {
  const Vec3 edges = average.box.max - average.box.min, period = c.domain.max - c.domain.min;
  CoarseGrid grid;
  grid.origin = average.box.min, grid.width = average.width;
  grid.cells = {cells_along(edges.x, average.spacing), cells_along(edges.y, average.spacing),
                cells_along(edges.z, average.spacing)};
  grid.spacing = {edges.x / grid.cells[0], edges.y / grid.cells[1], edges.z / grid.cells[2]};
  const auto covers = [](double edge, double whole) { return edge >= whole * (1 - 1e-9); };
  grid.wrap[0] = c.periodic[0] && covers(edges.x, period.x);
  grid.wrap[1] = c.periodic[1] && covers(edges.y, period.y);
  grid.wrap[2] = c.periodic[2] && covers(edges.z, period.z);
  return grid;
}

double memory_of_average(const AverageSettings& average) {
  return kBytesPerCell * volume_of(average.box) / std::pow(average.spacing, 3);
}

}  // namespace scree
