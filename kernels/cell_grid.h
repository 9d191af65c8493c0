// A dense grid of cells over the particles' bounding box. Particles are kept in Morton order of their cells, so a cell
// is a range of indices and neighbouring cells are mostly near in memory.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geometry/solid.h"

namespace scree {

class CellGrid {
 public:
  // Cells at least `min_cell` (m, > 0) wide, at most about `max_cells` of them: wider where the box is large and empty.
  // Along a periodic axis (period > 0) the cells divide the period evenly and neighbours wrap round.
  void lay(const Bounds& box, const double period[3], double min_cell, size_t max_cells);

  std::array<uint32_t, 3> cell_of(const Vec3& x) const;
  uint32_t morton(const std::array<uint32_t, 3>& c) const {
    return spread_[0][c[0]] | spread_[1][c[1]] | spread_[2][c[2]];
  }
  int morton_bits() const { return bits_; }
  size_t linear(const std::array<uint32_t, 3>& c) const { return (size_t{c[2]} * n_[1] + c[1]) * n_[0] + c[0]; }
  size_t size() const { return size_t{n_[0]} * n_[1] * n_[2]; }

  struct Range {
    uint32_t begin = 0, end = 0;  // particle indices
  };
  std::vector<Range> ranges;  // by linear(); filled by the rebuild

  // The cell `offset` away, at most one cell beyond the grid along an axis. Returns false outside the grid; `shift` is
  // what must be added to positions in that cell to see them as neighbours across a periodic border (m).
  bool neighbour(const std::array<uint32_t, 3>& c, const std::array<int, 3>& offset, std::array<uint32_t, 3>& other,
                 Vec3& shift) const;

  // The same along one axis.
  bool neighbour(int axis, uint32_t c, int offset, uint32_t& other, double& shift) const;

  size_t bytes() const { return ranges.capacity() * sizeof(Range); }

 private:
  Vec3 origin_{};
  double inverse_size_[3] = {1, 1, 1};
  double period_[3] = {0, 0, 0};
  std::array<uint32_t, 3> n_{1, 1, 1};
  std::vector<uint32_t> spread_[3];  // the bits of an axis' cell number at their places in the Morton code
  int bits_ = 0;
};

}  // namespace scree
