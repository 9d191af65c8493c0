// Finds the pairs of one chunk: active ones into blocks with their carried history, the rest of the skin into the lists
// of waiting pairs.
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
  double skin, middle, inner;  // m, beyond touching: listed, near, active
  const uint32_t* old_index;   // of each particle, for the history
  const HistoryTable<Real>* history;
  ChunkContacts<Real>* contacts;  // cleared by the caller
};

// Round-off of float positions relative to a cell's corner is 1e-7 of a cell; the lists reach this much further, so
// that no pair that the double test would list is missed.
inline constexpr float kSearchMargin = 1e-5f;

inline constexpr float kElsewhere = 1e9f;  // a rank above all of a chunk

// Particles of up to 4 x 4 x 4 cells (a run in Morton order: a family) share one gathering of candidates.
inline constexpr uint32_t kFamilyBits = 2, kMostAround = (1u << kFamilyBits) + 2;

// Particles of the cells around a family as float coordinates relative to `centre`, row after row of cells along x: the
// candidates of one of its particles are nine short runs.
class Candidates {
 public:
  std::vector<float> x, y, z, radius;
  std::vector<float> rank;  // in the chunk, from `first` on; kElsewhere outside it: i lists those of higher rank
  std::vector<uint32_t> index;
  std::vector<uint8_t> wraps;  // seen through a periodic border

  // Cells `low`..`high` and those around them. Particles begin..first are left out: their pairs with ours are listed
  // already (a pair inside a chunk is listed at its lower index).
  template <class Real>
  void gather(const SearchTask<Real>& task, const std::array<uint32_t, 3>& low, const std::array<uint32_t, 3>& high,
              uint32_t first, const Vec3& centre) {
    for (int a = 0; a < 3; ++a)
      for (uint32_t k = 0; k < high[a] - low[a] + 3; ++k)
        axis_[a][k].there =
            task.grid->neighbour(a, low[a], static_cast<int>(k) - 1, axis_[a][k].cell, axis_[a][k].shift);
    size_ = 0, low_ = low;
    for (uint32_t cz = 0; cz < high[2] - low[2] + 3; ++cz)
      for (uint32_t cy = 0; cy < high[1] - low[1] + 3; ++cy) {
        uint32_t* row = rows_[cz][cy];
        for (uint32_t cx = 0; cx < high[0] - low[0] + 3; ++cx) {
          *row++ = size_;
          const AxisCell &along_x = axis_[0][cx], &along_y = axis_[1][cy], &along_z = axis_[2][cz];
          if (along_x.there && along_y.there && along_z.there)
            gather_cell(task, task.grid->linear({along_x.cell, along_y.cell, along_z.cell}),
                        {along_x.shift, along_y.shift, along_z.shift}, first, centre);
        }
        *row = size_;
      }
    reserve(size_ + kBlock);  // the last run's vector reads beyond it
  }

  uint32_t size() const { return size_; }

  struct Run {
    uint32_t begin, end;
  };
  // The cells around `cell` in the row (dy, dz) next to it, -1..1.
  Run run(const std::array<uint32_t, 3>& cell, int dy, int dz) const {
    const uint32_t* row = rows_[cell[2] - low_[2] + 1 + dz][cell[1] - low_[1] + 1 + dy] + (cell[0] - low_[0]);
    return {row[0], row[3]};
  }

 private:
  void reserve(size_t count) {
    if (wraps.size() >= count) return;  // the last to grow: no memory may have been left on the way
    count += count / 2 + 64;
    for (auto* column : {&x, &y, &z, &radius, &rank}) column->resize(count);
    index.resize(count);
    wraps.resize(count);
  }

  template <class Real>
  void gather_cell(const SearchTask<Real>& task, size_t cell, const Vec3& shift, uint32_t first, const Vec3& centre) {
    CellGrid::Range range = task.grid->ranges[cell];
    if (range.begin >= task.begin && range.begin < first) range.begin = std::min(range.end, first);
    reserve(size_ + (range.end - range.begin));
    const Vec3 from = centre - shift;
    const bool through_border = shift.x != 0 || shift.y != 0 || shift.z != 0;
    for (uint32_t k = range.begin; k < range.end; ++k, ++size_) {
      const Particle<Real>& p = task.particles[k];
      x[size_] = static_cast<float>(p.x - from.x);
      y[size_] = static_cast<float>(p.y - from.y);
      z[size_] = static_cast<float>(p.z - from.z);
      radius[size_] = static_cast<float>(p.radius);
      const bool here = k >= task.begin && k < task.end;
      rank[size_] = here ? static_cast<float>(static_cast<int64_t>(k) - int64_t{first}) : kElsewhere;
      index[size_] = k;
      wraps[size_] = through_border;
    }
  }

  struct AxisCell {
    uint32_t cell;
    double shift;
    bool there;
  };
  AxisCell axis_[3][kMostAround];
  uint32_t rows_[kMostAround][kMostAround][kMostAround + 1];  // where each cell begins, by z, y, x; and the row's end
  std::array<uint32_t, 3> low_{};
  uint32_t size_ = 0;
};

// The lists that a pair may come into, nearest first.
enum PairList : uint8_t { kActive, kNear, kFar, kPairLists };

struct ListedPair {
  uint32_t i, j;
  PairList list;
};

// What the search for one particle finds, as places among the candidates: all, then apart by list.
struct FoundPairs {
  std::vector<uint32_t> all, of[kPairLists];

  void reserve(size_t count) {
    if (of[kPairLists - 1].size() >= count) return;
    all.resize(count);
    for (auto& list : of) list.resize(count);
  }
};

// A particle as the candidates are given: relative to their centre.
struct SearchSphere {
  float x, y, z, radius, rank;
};

// Whether spheres are nearer than `gap` to touching, so far as float tells.
template <class F>
inline auto within(const Vec<F>& d, const F& radius_and_gap, const F& other_radius) {
  const F reach = (radius_and_gap + other_radius) * F(1 + kSearchMargin);
  return dot(d, d) <= reach * reach;
}

// Places of the candidates that p lists; returns how many. Few of those looked at are, and which is chance: no branch
// depends on it.
template <class S>
inline uint32_t find_pairs(const Candidates& c, const SearchSphere& p, const std::array<uint32_t, 3>& cell, double gap,
                           uint32_t* found) {
  using F = typename S::F;
  const float *x = c.x.data(), *y = c.y.data(), *z = c.z.data(), *radius = c.radius.data(), *rank = c.rank.data();
  const F own(static_cast<float>(p.radius + gap)), own_rank(p.rank);
  const Vec<F> at{F(p.x), F(p.y), F(p.z)};
  uint32_t count = 0;
  for (int row = 0; row < 9; ++row) {
    const auto [begin, end] = c.run(cell, row % 3 - 1, row / 3 - 1);
    for (uint32_t k = begin; k < end; k += S::width) {
      const Vec<F> d = at - Vec<F>{S::load(x + k), S::load(y + k), S::load(z + k)};
      const auto listed =
          within(d, own, S::load(radius + k)) & (S::load(rank + k) > own_rank) & S::first_lanes(end - k);
      count += S::store_lanes(listed, k, found + count);
    }
  }
  return count;
}

template <class Real>
inline void list_pair(const SearchTask<Real>& task, const typename HistoryTable<Real>::Pairs& histories,
                      const ListedPair& pair) {
  ChunkContacts<Real>& contacts = *task.contacts;
  if (pair.list == kActive) {
    auto& block = contacts.append(pair.i, pair.j);
    histories.copy(task.old_index[pair.j], block.history[0] + (contacts.pairs - 1) % kBlock);
  } else {
    (pair.list == kNear ? contacts.near : contacts.far).push_back({pair.i, pair.j});
  }
}

// `first`: where the particle's family begins. Pairs through a periodic border wait in `wrapping` until the chunk's
// other pairs are listed: they come last.
template <class L>
inline void search_particle(const SearchTask<typename L::Real>& task, const Candidates& c, uint32_t i, uint32_t first,
                            const std::array<uint32_t, 3>& cell, const Vec3& centre, FoundPairs& found,
                            std::vector<ListedPair>& wrapping) {
  using Real = typename L::Real;
  using S = std::conditional_t<L::width == 1, ScalarLanes<float>, L>;  // floats, whatever the storage type
  const Particle<Real>& own = task.particles[i];
  const SearchSphere p{static_cast<float>(own.x - centre.x), static_cast<float>(own.y - centre.y),
                       static_cast<float>(own.z - centre.z), static_cast<float>(own.radius),
                       static_cast<float>(i - first)};
  const uint32_t count = find_pairs<S>(c, p, cell, task.skin, found.all.data());
  const float middle = static_cast<float>(p.radius + task.middle), inner = static_cast<float>(p.radius + task.inner);
  uint32_t sizes[kPairLists] = {};
  const uint32_t* const all = found.all.data();
  uint32_t* const of[kPairLists] = {found.of[kActive].data(), found.of[kNear].data(), found.of[kFar].data()};
  for (uint32_t n = 0; n < count; ++n) {
    const uint32_t k = all[n];
    const Vec<float> d{p.x - c.x[k], p.y - c.y[k], p.z - c.z[k]};
    const int list = !within(d, middle, c.radius[k]) + !within(d, inner, c.radius[k]);
    of[list][sizes[list]++] = k;
  }
  const typename HistoryTable<Real>::Pairs histories(*task.history, task.old_index[i]);
  for (const PairList list : {kActive, kNear, kFar})
    for (uint32_t n = 0; n < sizes[list]; ++n) {
      const uint32_t k = of[list][n];
      const ListedPair pair{i, c.index[k], list};
      if (c.wraps[k])
        wrapping.push_back(pair);
      else
        list_pair(task, histories, pair);
    }
}

template <class L>
void search_chunk(const SearchTask<typename L::Real>& task) {
  using Cell = std::array<uint32_t, 3>;
  thread_local Candidates candidates;
  thread_local FoundPairs found;
  thread_local std::vector<ListedPair> wrapping;
  wrapping.clear();
  const auto position = [&](uint32_t k) { return Vec3{task.particles[k].x, task.particles[k].y, task.particles[k].z}; };
  const auto family_of = [](const Cell& c) {
    return Cell{c[0] >> kFamilyBits, c[1] >> kFamilyBits, c[2] >> kFamilyBits};
  };
  for (uint32_t first = task.begin; first < task.end;) {
    struct {
      Cell cell;
      uint32_t begin;
    } members[1u << 3 * kFamilyBits];
    uint32_t count = 0, last = first;
    Cell low = task.grid->cell_of(position(first)), high = low;
    const Cell family = family_of(low);
    for (Cell cell = low; family_of(cell) == family; cell = task.grid->cell_of(position(last))) {
      for (int a = 0; a < 3; ++a) low[a] = std::min(low[a], cell[a]), high[a] = std::max(high[a], cell[a]);
      members[count++] = {cell, last};
      last = std::min(task.end, task.grid->ranges[task.grid->linear(cell)].end);
      if (last == task.end) break;
    }
    const Vec3 centre = position(first);
    candidates.gather(task, low, high, first, centre);
    found.reserve(candidates.size() + kBlock);
    for (uint32_t m = 0; m < count; ++m)
      for (uint32_t i = members[m].begin; i < (m + 1 < count ? members[m + 1].begin : last); ++i)
        search_particle<L>(task, candidates, i, first, members[m].cell, centre, found, wrapping);
    first = last;
  }
  if (wrapping.empty()) return;
  task.contacts->first_wrapping = task.contacts->pairs / kBlock;
  for (const ListedPair& p : wrapping) list_pair(task, {*task.history, task.old_index[p.i]}, p);
}

}  // namespace scree
