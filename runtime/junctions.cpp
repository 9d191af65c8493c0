#include "runtime/junctions.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace scree {

namespace {

constexpr double kSamePoint = 1e-3;  // of the reach

}  // namespace

Junctions::Junctions(const Solid& solid) {
  std::vector<const Segment*> axes;
  std::vector<double> lengths;
  for (const Primitive& p : solid.primitives) {
    const auto* axis = std::get_if<Segment>(&p.skeleton);
    if (!axis) continue;
    axes.push_back(axis);
    lengths.push_back(norm(axis->b - axis->a));
  }
  if (axes.empty()) return;
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  reach_ = *middle / std::numbers::sqrt2;
  for (const Segment* axis : axes)
    for (const Vec3& end : {axis->a, axis->b}) {
      if (nearest_within(end, kSamePoint * reach_)) continue;
      cells_[cell_of(end)].push_back(points_.size());
      points_.push_back(end);
    }
}

Junctions::Cell Junctions::cell_of(const Vec3& x) const {
  const auto whole = [&](double v) { return static_cast<int64_t>(std::floor(v / reach_)); };
  return {whole(x.x), whole(x.y), whole(x.z)};
}

std::optional<size_t> Junctions::nearest(const Vec3& x) const {
  // Points that lie exactly at the reach belong to it.
  return reach_ > 0 ? nearest_within(x, reach_ * (1 + 1e-9)) : std::nullopt;
}

std::optional<size_t> Junctions::nearest_within(const Vec3& x, double reach) const {
  const Cell centre = cell_of(x);
  std::optional<size_t> best;
  double least = reach;
  for (int64_t dz = -1; dz <= 1; ++dz)
    for (int64_t dy = -1; dy <= 1; ++dy)
      for (int64_t dx = -1; dx <= 1; ++dx) {
        const auto cell = cells_.find({centre.x + dx, centre.y + dy, centre.z + dz});
        if (cell == cells_.end()) continue;
        for (const size_t k : cell->second)
          if (const double d = norm(points_[k] - x); d <= least) least = d, best = k;
      }
  return best;
}

}  // namespace scree
