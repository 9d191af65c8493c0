// Spreads what particles carry over the cells of a grid: the sums that continuum fields are made of.
//
// A sample at x gives each cell the share w of its values, by the kernel
//
//     w(x, cell) ~ L(dx / width) L(dy / width) L(dz / width),    L(q) = (1 + 3 |q|) (1 - |q|)^3 for |q| < 1, else 0,
//
// Lucy's polynomial along each axis, from x to the cell's centre, divided by its sum over the cells: the shares of one
// sample add up to 1, so that the cells' sum is the samples' sum to round-off, also beside the faces of the grid, whose
// cells take what would fall outside. Samples outside the grid give nothing.
//
// Sources: L. B. Lucy, Astronomical J. 82 (1977) 1013; I. Goldhirsch, Granular Matter 12 (2010) 239.
#pragma once

#include <array>
#include <span>

#include "geometry/solid.h"

namespace scree {

struct CoarseGrid {
  Vec3 origin{};               // m, corner with the smallest coordinates
  Vec3 spacing{};              // m, edges of a cell
  std::array<int, 3> cells{};  // along x, y, z; x runs fastest in arrays
  double width = 0;            // m, half-width of the kernel: at least a cell's edge, at most kWidestKernel of them
  bool wrap[3] = {};           // the grid covers a period along this axis: what leaves comes in on the other side
  static constexpr int kWidestKernel = 8;  // cell edges

  size_t size() const { return size_t(cells[0]) * cells[1] * cells[2]; }
  double cell_volume() const { return spacing.x * spacing.y * spacing.z; }
  Vec3 centre(size_t cell) const;
  bool holds(const Vec3& x) const;      // faces belong to the grid; axes that wrap hold every x
  size_t cell_of(const Vec3& x) const;  // the cell that x is in, or the nearest
};

// Variance of the kernel along one axis, m2: 2/21 width^2.
inline double kernel_variance(const CoarseGrid& grid) { return 2.0 / 21 * grid.width * grid.width; }

template <size_t N>
struct CoarseSample {
  Vec3 x{};                        // m
  std::array<double, N> values{};  // anything that adds up
};

// sums[cell * N + n] += share of the cell * values[n], over all samples in their order: the same bits for any number of
// threads. sums holds grid.size() * N values.
template <size_t N>
void deposit(const CoarseGrid& grid, std::span<const CoarseSample<N>> samples, std::span<double> sums);

// The mean of a field (a value for each cell) as one sample at the cell's centre would spread over it.
double seen_through_kernel(const CoarseGrid& grid, std::span<const double> field, size_t cell);

inline constexpr size_t kGrainValues = 12, kStressValues = 6;
extern template void deposit(const CoarseGrid&, std::span<const CoarseSample<kGrainValues>>, std::span<double>);
extern template void deposit(const CoarseGrid&, std::span<const CoarseSample<kStressValues>>, std::span<double>);

}  // namespace scree
