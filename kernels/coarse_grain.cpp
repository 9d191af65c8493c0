#include "kernels/coarse_grain.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "kernels/parallel.h"

namespace scree {

namespace {

constexpr int kSlab = 8;  // layers of cells along z that one piece of work owns

// The cells first, first + 1, ... along one axis that a sample reaches, and their shares; before wrapping.
struct Reach {
  int first = 0, count = 0;
  double share[2 * CoarseGrid::kWidestKernel + 2];
};

double lucy(double q) {
  const double rest = std::max(0.0, 1 - q);
  return (1 + 3 * q) * rest * rest * rest;
}

int first_reached(double at, double width) { return static_cast<int>(std::ceil(at - width - 0.5)); }
int last_reached(double at, double width) { return static_cast<int>(std::floor(at + width - 0.5)); }

// `at` and `width` in cell edges from the grid's corner.
Reach reach_of(double at, double width, int cells, bool wrap) {
  Reach r;
  int last = last_reached(at, width);
  r.first = first_reached(at, width);
  if (!wrap) r.first = std::max(r.first, 0), last = std::min(last, cells - 1);
  r.count = last - r.first + 1;
  double sum = 0;
  for (int k = 0; k < r.count; ++k) sum += r.share[k] = lucy(std::abs(r.first + k + 0.5 - at) / width);
  for (int k = 0; k < r.count; ++k) r.share[k] /= sum;
  return r;
}

int wrapped(int k, int cells) { return (k % cells + cells) % cells; }

struct Place {
  double x, y, z;  // in cell edges from the grid's corner
};

Place place_of(const CoarseGrid& g, const Vec3& x) {
  const auto one = [](double from, double edge, double at, int cells, bool wrap) {
    const double q = (at - from) / edge;
    return wrap ? q - cells * std::floor(q / cells) : q;
  };
  return {one(g.origin.x, g.spacing.x, x.x, g.cells[0], g.wrap[0]),
          one(g.origin.y, g.spacing.y, x.y, g.cells[1], g.wrap[1]),
          one(g.origin.z, g.spacing.z, x.z, g.cells[2], g.wrap[2])};
}

// Visits the layer of each cell along z that a sample at z (in cell edges) reaches.
template <class Visit>
void for_each_layer(const CoarseGrid& g, double z, const Visit& visit) {
  const double width = g.width / g.spacing.z;
  int first = first_reached(z, width), last = last_reached(z, width);
  if (!g.wrap[2]) first = std::max(first, 0), last = std::min(last, g.cells[2] - 1);
  for (int k = first; k <= last; ++k) visit(g.wrap[2] ? wrapped(k, g.cells[2]) : k);
}

// The indices of the samples that reach each slab, in their order.
template <size_t N>
std::vector<std::vector<uint32_t>> samples_of_slabs(const CoarseGrid& g, std::span<const CoarseSample<N>> samples) {
  std::vector<std::vector<uint32_t>> slabs((g.cells[2] + kSlab - 1) / kSlab);
  for (uint32_t s = 0; s < samples.size(); ++s) {
    if (!g.holds(samples[s].x)) continue;
    for_each_layer(g, place_of(g, samples[s].x).z, [&](int layer) {
      auto& slab = slabs[layer / kSlab];
      if (slab.empty() || slab.back() != s) slab.push_back(s);
    });
  }
  return slabs;
}

template <size_t N>
void deposit_one(const CoarseGrid& g, const CoarseSample<N>& sample, int slab, std::span<double> sums) {
  const Place at = place_of(g, sample.x);
  const Reach x = reach_of(at.x, g.width / g.spacing.x, g.cells[0], g.wrap[0]);
  const Reach y = reach_of(at.y, g.width / g.spacing.y, g.cells[1], g.wrap[1]);
  const Reach z = reach_of(at.z, g.width / g.spacing.z, g.cells[2], g.wrap[2]);
  for (int kz = 0; kz < z.count; ++kz) {
    const int layer = g.wrap[2] ? wrapped(z.first + kz, g.cells[2]) : z.first + kz;
    if (layer / kSlab != slab) continue;
    for (int ky = 0; ky < y.count; ++ky) {
      const int row = g.wrap[1] ? wrapped(y.first + ky, g.cells[1]) : y.first + ky;
      const double share = z.share[kz] * y.share[ky];
      const size_t line = (size_t(layer) * g.cells[1] + row) * g.cells[0];
      for (int kx = 0; kx < x.count; ++kx) {
        const int column = g.wrap[0] ? wrapped(x.first + kx, g.cells[0]) : x.first + kx;
        double* sum = &sums[(line + column) * N];
        const double w = share * x.share[kx];
        for (size_t n = 0; n < N; ++n) sum[n] += w * sample.values[n];
      }
    }
  }
}

bool within(double x, double from, double edge, int cells) { return x >= from && x <= from + cells * edge; }

}  // namespace

double seen_through_kernel(const CoarseGrid& g, std::span<const double> field, size_t cell) {
  const int x = static_cast<int>(cell % g.cells[0]), y = static_cast<int>(cell / g.cells[0] % g.cells[1]),
            z = static_cast<int>(cell / g.cells[0] / g.cells[1]);
  const Reach along_x = reach_of(x + 0.5, g.width / g.spacing.x, g.cells[0], g.wrap[0]),
              along_y = reach_of(y + 0.5, g.width / g.spacing.y, g.cells[1], g.wrap[1]),
              along_z = reach_of(z + 0.5, g.width / g.spacing.z, g.cells[2], g.wrap[2]);
  double mean = 0;
  for (int c = 0; c < along_z.count; ++c)
    for (int b = 0; b < along_y.count; ++b)
      for (int a = 0; a < along_x.count; ++a) {
        const size_t row =
            size_t(wrapped(along_z.first + c, g.cells[2])) * g.cells[1] + wrapped(along_y.first + b, g.cells[1]);
        mean += along_x.share[a] * along_y.share[b] * along_z.share[c] *
                field[row * g.cells[0] + wrapped(along_x.first + a, g.cells[0])];
      }
  return mean;
}

Vec3 CoarseGrid::centre(size_t cell) const {
  const size_t nx = cells[0], ny = cells[1];
  const size_t i = cell % nx, j = cell / nx % ny, k = cell / (nx * ny);
  const auto middle = [](size_t number, double edge) { return (static_cast<double>(number) + 0.5) * edge; };
  return origin + Vec3{middle(i, spacing.x), middle(j, spacing.y), middle(k, spacing.z)};
}

bool CoarseGrid::holds(const Vec3& x) const {
  return (wrap[0] || within(x.x, origin.x, spacing.x, cells[0])) &&
         (wrap[1] || within(x.y, origin.y, spacing.y, cells[1])) &&
         (wrap[2] || within(x.z, origin.z, spacing.z, cells[2]));
}

size_t CoarseGrid::cell_of(const Vec3& x) const {
  const Place at = place_of(*this, x);
  const auto index = [](double q, int n) { return size_t(std::clamp(static_cast<int>(std::floor(q)), 0, n - 1)); };
  return (index(at.z, cells[2]) * cells[1] + index(at.y, cells[1])) * cells[0] + index(at.x, cells[0]);
}

template <size_t N>
void deposit(const CoarseGrid& grid, std::span<const CoarseSample<N>> samples, std::span<double> sums) {
  const auto slabs = samples_of_slabs(grid, samples);
  parallel_for(slabs.size(), [&](size_t slab) {
    for (uint32_t s : slabs[slab]) deposit_one(grid, samples[s], static_cast<int>(slab), sums);
  });
}

template void deposit(const CoarseGrid&, std::span<const CoarseSample<kGrainValues>>, std::span<double>);
template void deposit(const CoarseGrid&, std::span<const CoarseSample<kStressValues>>, std::span<double>);

}  // namespace scree
