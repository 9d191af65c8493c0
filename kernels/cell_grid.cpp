#include "kernels/cell_grid.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace scree {

namespace {

constexpr uint32_t kMaxCellsPerAxis = 1u << 16;

// Interleaves the axes' bits from the lowest up; an axis that has run out of bits leaves its places to the others.
void spread_bits(const std::array<uint32_t, 3>& n, std::vector<uint32_t> (&spread)[3], int& total) {
  int place_of[3][32] = {};
  int bits[3];
  for (int a = 0; a < 3; ++a) bits[a] = n[a] > 1 ? std::bit_width(n[a] - 1) : 0;
  total = 0;
  for (int level = 0; level < 32; ++level)
    for (int a = 0; a < 3; ++a)
      if (level < bits[a]) place_of[a][level] = total++;
  for (int a = 0; a < 3; ++a) {
    spread[a].assign(n[a], 0);
    for (uint32_t c = 0; c < n[a]; ++c)
      for (int level = 0; level < bits[a]; ++level)
        if (c >> level & 1u) spread[a][c] |= 1u << place_of[a][level];
  }
}

}  // namespace

void CellGrid::lay(const Bounds& box, const double period[3], double min_cell, size_t max_cells) {
  const double extent[3] = {box.max.x - box.min.x, box.max.y - box.min.y, box.max.z - box.min.z};
  origin_ = box.min;
  for (int a = 0; a < 3; ++a) period_[a] = period[a];
  // Codes of 32 bits hold any grid of at most 2^29 cells, since an axis wastes less than one bit.
  max_cells = std::min<size_t>(max_cells, size_t{1} << 29);
  for (double cell = min_cell;; cell *= 1.26) {
    double product = 1;
    double count[3];
    for (int a = 0; a < 3; ++a) {
      const double length = period[a] > 0 ? period[a] : extent[a];
      count[a] = std::max(1.0, period[a] > 0 ? std::floor(length / cell) : std::floor(length / cell) + 1);
      product *= count[a];
    }
    const bool fits =
        product <= static_cast<double>(max_cells) && *std::max_element(count, count + 3) <= kMaxCellsPerAxis;
    if (!fits) continue;
    for (int a = 0; a < 3; ++a) {
      n_[a] = static_cast<uint32_t>(count[a]);
      inverse_size_[a] = period[a] > 0 ? n_[a] / period[a] : 1 / cell;
    }
    break;
  }
  spread_bits(n_, spread_, bits_);
  ranges.assign(size(), {});
}

std::array<uint32_t, 3> CellGrid::cell_of(const Vec3& x) const {
  const double offset[3] = {x.x - origin_.x, x.y - origin_.y, x.z - origin_.z};
  std::array<uint32_t, 3> c;
  for (int a = 0; a < 3; ++a) {
    const double at = std::max(0.0, offset[a] * inverse_size_[a]);
    c[a] = at < n_[a] ? static_cast<uint32_t>(at) : n_[a] - 1;
  }
  return c;
}

bool CellGrid::neighbour(int axis, uint32_t c, int offset, uint32_t& other, double& shift) const {
  int64_t at = int64_t{c} + offset;
  shift = 0;
  if (at < 0 || at >= n_[axis]) {
    if (period_[axis] <= 0) return false;
    shift = at < 0 ? -period_[axis] : period_[axis];
    at += at < 0 ? n_[axis] : -int64_t{n_[axis]};
  }
  other = static_cast<uint32_t>(at);
  return true;
}

bool CellGrid::neighbour(const std::array<uint32_t, 3>& c, const std::array<int, 3>& offset,
                         std::array<uint32_t, 3>& other, Vec3& shift) const {
  return neighbour(0, c[0], offset[0], other[0], shift.x) && neighbour(1, c[1], offset[1], other[1], shift.y) &&
         neighbour(2, c[2], offset[2], other[2], shift.z);
}

}  // namespace scree
