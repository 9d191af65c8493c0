// Finds the pairs of one chunk: active ones into blocks with their carried history, the rest of the skin into `near`.
#pragma once

#include <cmath>
#include <vector>

#include "kernels/cell_grid.h"
#include "kernels/history_table.h"
#include "kernels/particle.h"
#include "kernels/simd.h"

namespace scree {

template <class Real>
struct SearchTask {
  const Particle<Real>* particles;  // in Morton order
  uint32_t begin, end, count;
  const CellGrid* grid;
  double skin, inner;               // m, beyond touching: listed, active
  const uint32_t* old_index;        // of each particle, for the history
  const HistoryTable<Real>* history;
  ChunkContacts<Real>* contacts;    // cleared by the caller
};

// Round-off of float positions relative to a cell's corner is 1e-7 of a cell; the lists reach this much further, so that
// no pair that the double test would list is missed.
inline constexpr float kSearchMargin = 1e-5f;

// Particles of a cell's neighbourhood as float coordinates relative to `centre`.
struct Candidates {
  std::vector<float> x, y, z, radius;
  std::vector<uint32_t> index;
  size_t size = 0;

  void reserve(size_t count) {
    if (x.size() >= count) return;
    count += count / 2 + 64;
    x.resize(count), y.resize(count), z.resize(count), radius.resize(count), index.resize(count);
  }

  template <class Real>
  void gather(const Particle<Real>* particles, const CellGrid& grid, const std::array<uint32_t, 3>& cell, const Vec3& centre) {
    size = 0;
    for (int dz = -1; dz <= 1; ++dz)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
          std::array<uint32_t, 3> other;
          Vec3 shift;
          if (!grid.neighbour(cell, {dx, dy, dz}, other, shift)) continue;
          const CellGrid::Range range = grid.ranges[grid.linear(other)];
          reserve(size + (range.end - range.begin) + 16);
          for (uint32_t k = range.begin; k < range.end; ++k, ++size) {
            const Particle<Real>& p = particles[k];
            x[size] = static_cast<float>(p.x + shift.x - centre.x);
            y[size] = static_cast<float>(p.y + shift.y - centre.y);
            z[size] = static_cast<float>(p.z + shift.z - centre.z);
            radius[size] = static_cast<float>(p.radius);
            index[size] = k;
          }
        }
    for (size_t k = size; k < size + 16; ++k) x[k] = y[k] = z[k] = 1e6f, radius[k] = 0, index[k] = 0;  // padding, far away
  }
};

template <class L>
inline void emit_pair(const SearchTask<typename L::Real>& task, uint32_t i, uint32_t j, bool active) {
  if (!active) {
    task.contacts->near.push_back({i, j});
    return;
  }
  auto& block = task.contacts->append(i, j, task.count);
  task.history->copy_pair(task.old_index[i], task.old_index[j], block.history[0] + (task.contacts->pairs - 1) % kBlock);
}

// N lanes of floats, whatever the storage type.
template <class L>
inline void search_particle(const SearchTask<typename L::Real>& task, const Candidates& c, uint32_t i, const Vec3& centre) {
  using S = std::conditional_t<L::width == 1, ScalarLanes<float>, L>;
  using F = typename S::F;
  const auto& p = task.particles[i];
  const F x(static_cast<float>(p.x - centre.x)), y(static_cast<float>(p.y - centre.y)), z(static_cast<float>(p.z - centre.z));
  const float radius = static_cast<float>(p.radius);
  const F outer(static_cast<float>(radius + task.skin)), inner(static_cast<float>(radius + task.inner));
  const F margin(1 + kSearchMargin);
  for (size_t k = 0; k < c.size; k += S::width) {
    const Vec<F> d{x - S::load(&c.x[k]), y - S::load(&c.y[k]), z - S::load(&c.z[k])};
    const F distance2 = dot(d, d), other = S::load(&c.radius[k]);
    const F outer_reach = (outer + other) * margin, inner_reach = (inner + other) * margin;
    unsigned listed = S::bits(distance2 <= outer_reach * outer_reach);
    if (listed == 0) continue;
    const unsigned active = S::bits(distance2 <= inner_reach * inner_reach);
    for (; listed != 0; listed &= listed - 1) {
      const int lane = __builtin_ctz(listed);
      const uint32_t j = c.index[k + static_cast<size_t>(lane)];
      if (j > i || j < task.begin) emit_pair<L>(task, i, j, active >> lane & 1u);
    }
  }
}

template <class L>
void search_chunk(const SearchTask<typename L::Real>& task) {
  thread_local Candidates candidates;
  const auto position = [&](uint32_t k) { return Vec3{task.particles[k].x, task.particles[k].y, task.particles[k].z}; };
  for (uint32_t first = task.begin; first < task.end;) {
    const auto cell = task.grid->cell_of(position(first));
    const Vec3 centre = position(first);
    const uint32_t last = std::min(task.end, task.grid->ranges[task.grid->linear(cell)].end);
    candidates.gather(task.particles, *task.grid, cell, centre);
    for (uint32_t i = first; i < last; ++i) search_particle<L>(task, candidates, i, centre);
    first = last;
  }
}

}  // namespace scree
