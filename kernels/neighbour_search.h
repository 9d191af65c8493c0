// Finds the pairs of one chunk: active ones into blocks with their carried history, the rest of the skin into `near`.
#pragma once

#include <algorithm>
#include <array>
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
  double skin, inner;         // m, beyond touching: listed, active
  const uint32_t* old_index;  // of each particle, for the history
  const HistoryTable<Real>* history;
  ChunkContacts<Real>* contacts;  // cleared by the caller
};

// Round-off of float positions relative to a cell's corner is 1e-7 of a cell; the lists reach this much further, so
// that no pair that the double test would list is missed.
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

  // Cells `low`..`high` and those around them. Particles begin..first are left out: their pairs with ours are listed
  // already (a pair inside a chunk is listed at its lower index).
  template <class Real>
  void gather(const SearchTask<Real>& task, const std::array<uint32_t, 3>& low, const std::array<uint32_t, 3>& high,
              uint32_t first, const Vec3& centre) {
    size = 0;
    const auto span = [&](int axis) { return static_cast<int>(high[axis] - low[axis]) + 1; };
    for (int dz = -1; dz <= span(2); ++dz)
      for (int dy = -1; dy <= span(1); ++dy)
        for (int dx = -1; dx <= span(0); ++dx) {
          std::array<uint32_t, 3> other;
          Vec3 shift;
          if (!task.grid->neighbour(low, {dx, dy, dz}, other, shift)) continue;
          CellGrid::Range range = task.grid->ranges[task.grid->linear(other)];
          if (range.begin >= task.begin && range.begin < first) range.begin = std::min(range.end, first);
          reserve(size + (range.end - range.begin) + 16);
          for (uint32_t k = range.begin; k < range.end; ++k, ++size) {
            const Particle<Real>& p = task.particles[k];
            x[size] = static_cast<float>(p.x + shift.x - centre.x);
            y[size] = static_cast<float>(p.y + shift.y - centre.y);
            z[size] = static_cast<float>(p.z + shift.z - centre.z);
            radius[size] = static_cast<float>(p.radius);
            index[size] = k;
          }
        }
    for (size_t k = size; k < size + 16; ++k)
      x[k] = y[k] = z[k] = 1e6f, radius[k] = 0, index[k] = 0;  // padding, far away
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
inline void search_particle(const SearchTask<typename L::Real>& task, const Candidates& c, uint32_t i,
                            const Vec3& centre) {
  using S = std::conditional_t<L::width == 1, ScalarLanes<float>, L>;
  using F = typename S::F;
  const auto& p = task.particles[i];
  const F x(static_cast<float>(p.x - centre.x)), y(static_cast<float>(p.y - centre.y)),
      z(static_cast<float>(p.z - centre.z));
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

// Particles of up to 2 x 2 x 2 cells (a run in Morton order) share one gathering of candidates: a cell holds about one
// particle, its neighbourhood fifty.
template <class L>
void search_chunk(const SearchTask<typename L::Real>& task) {
  thread_local Candidates candidates;
  const auto position = [&](uint32_t k) { return Vec3{task.particles[k].x, task.particles[k].y, task.particles[k].z}; };
  const auto cell_of = [&](uint32_t k) { return task.grid->cell_of(position(k)); };
  for (uint32_t first = task.begin; first < task.end;) {
    std::array<uint32_t, 3> low = cell_of(first), high = low;
    const std::array<uint32_t, 3> family{low[0] / 2, low[1] / 2, low[2] / 2};
    uint32_t last = first;
    for (auto cell = low; last < task.end;) {
      for (int a = 0; a < 3; ++a) low[a] = std::min(low[a], cell[a]), high[a] = std::max(high[a], cell[a]);
      last = std::min(task.end, task.grid->ranges[task.grid->linear(cell)].end);
      if (last == task.end) break;
      cell = cell_of(last);
      if (std::array<uint32_t, 3>{cell[0] / 2, cell[1] / 2, cell[2] / 2} != family) break;
    }
    const Vec3 centre = position(first);
    candidates.gather(task, low, high, first, centre);
    for (uint32_t i = first; i < last; ++i) search_particle<L>(task, candidates, i, centre);
    first = last;
  }
}

}  // namespace scree
