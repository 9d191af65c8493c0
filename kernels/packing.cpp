#include "kernels/packing.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "geometry/bounds.h"
#include "kernels/cell_grid.h"
#include "kernels/parallel.h"
#include "kernels/radix_sort.h"

namespace scree {

namespace {

constexpr double kTargetGap =
    5e-3;  // of the radii: pushed this much further apart than touching, so that the end is reached
constexpr double kPush = 0.55;     // of an overlap, for each of the two spheres: half, and a little over-relaxation
constexpr double kListGap = 0.15;  // of the largest diameter: neighbours kept in the lists
constexpr size_t kPiece = 1024;

class Packing {
 public:
  Packing(std::span<PackedSphere> spheres, std::span<const PackedSphere> fixed, const Confine& confine)
      : moving_(spheres.size()), confine_(confine), out_(spheres) {
    all_.assign(spheres.begin(), spheres.end());
    all_.insert(all_.end(), fixed.begin(), fixed.end());
    for (const PackedSphere& s : all_) max_radius_ = std::max(max_radius_, s.radius);
    next_.resize(moving_);
    confined_.assign(moving_, 0);
    sort_along_curve();
  }

  PackingOutcome run(int max_iterations, const std::function<void(const PackingOutcome&)>& look) {
    PackingOutcome outcome;
    find_neighbours();
    for (; outcome.iterations < max_iterations; ++outcome.iterations) {
      look(outcome);
      const Sweep s = sweep();
      outcome.worst_overlap = s.worst_overlap;
      outcome.confined = s.worst_overlap <= 0 && all_confined();
      if (outcome.confined) break;
      for (size_t k = 0; k < moving_; ++k) all_[k].position = next_[k];
      travel_ += s.longest_way;
      if (2 * travel_ > kListGap * max_radius_) find_neighbours();
    }
    for (size_t k = 0; k < moving_; ++k) out_[order_[k]] = all_[k];
    return outcome;
  }

 private:
  struct Sweep {
    double worst_overlap = 0, longest_way = 0;
  };

  // packed_: the spheres along the grid's Morton curve, index in the low half.
  void sort_into_grid() {
    Bounds bounds = empty_bounds();
    for (const PackedSphere& s : all_) bounds = united(bounds, {s.position, s.position});
    const double none[3] = {0, 0, 0};
    const double reach = 2 * max_radius_ * (1 + kTargetGap) + kListGap * max_radius_;
    grid_.lay(bounds, none, reach, std::max<size_t>(4096, 4 * all_.size()));
    packed_.resize(all_.size());
    parallel_for_each(
        all_.size(), [&](size_t k) { packed_[k] = uint64_t{grid_.morton(grid_.cell_of(all_[k].position))} << 32 | k; });
    radix_sort(packed_, scratch_, grid_.morton_bits());
  }

  // Callers give spheres in any order; neighbours side by side in memory make the sweeps several times faster. Once is
  // enough: they do not go far.
  void sort_along_curve() {
    sort_into_grid();
    const std::vector<PackedSphere> before(all_.begin(), all_.begin() + static_cast<ptrdiff_t>(moving_));
    order_.reserve(moving_);
    for (const uint64_t p : packed_)
      if (const uint32_t k = static_cast<uint32_t>(p); k < moving_) {
        all_[order_.size()] = before[k];
        order_.push_back(k);
      }
  }

  void find_neighbours() {
    sort_into_grid();
    for (size_t k = 0; k < packed_.size(); ++k) {
      CellGrid::Range& range = grid_.ranges[grid_.linear(grid_.cell_of(all_[packed_[k] & 0xffffffffu].position))];
      if (range.end == 0) range.begin = static_cast<uint32_t>(k);
      range.end = static_cast<uint32_t>(k + 1);
    }
    neighbours_.resize(moving_);
    parallel_for((moving_ + kPiece - 1) / kPiece, [&](size_t piece) {
      for (size_t k = piece * kPiece; k < std::min(moving_, (piece + 1) * kPiece); ++k) list_neighbours(k);
    });
    travel_ = 0;
  }

  void list_neighbours(size_t k) {
    neighbours_[k].clear();
    const auto cell = grid_.cell_of(all_[k].position);
    for (int o = 0; o < 27; ++o) {
      std::array<uint32_t, 3> other;
      Vec3 shift;
      if (!grid_.neighbour(cell, {o % 3 - 1, o / 3 % 3 - 1, o / 9 - 1}, other, shift)) continue;
      const CellGrid::Range range = grid_.ranges[grid_.linear(other)];
      for (uint32_t r = range.begin; r < range.end; ++r) {
        const uint32_t j = static_cast<uint32_t>(packed_[r]);
        const double reach = (all_[k].radius + all_[j].radius) * (1 + kTargetGap) + kListGap * max_radius_;
        const Vec3 d = all_[k].position - all_[j].position;
        if (j != k && dot(d, d) <= reach * reach) neighbours_[k].push_back(j);
      }
    }
  }

  bool all_confined() const {
    std::atomic<bool> all{true};
    parallel_for_each(moving_, [&](size_t k) {
      if (norm(confine_(all_[k].position, all_[k].radius) - all_[k].position) > 1e-9 * all_[k].radius) all = false;
    });
    return all;
  }

  Sweep sweep() {
    std::vector<Sweep> partial((moving_ + kPiece - 1) / kPiece);
    parallel_for(partial.size(), [&](size_t piece) {
      for (size_t k = piece * kPiece; k < std::min(moving_, (piece + 1) * kPiece); ++k) relax(k, partial[piece]);
    });
    Sweep all;
    for (const Sweep& s : partial) {
      all.worst_overlap = std::max(all.worst_overlap, s.worst_overlap);
      all.longest_way = std::max(all.longest_way, s.longest_way);
    }
    return all;
  }

  void relax(size_t k, Sweep& s) {
    const PackedSphere& a = all_[k];
    Vec3 push{0, 0, 0};
    for (const uint32_t j : neighbours_[k]) {
      const PackedSphere& b = all_[j];
      const Vec3 d = a.position - b.position;
      const double r = norm(d), sum = a.radius + b.radius, overlap = sum * (1 + kTargetGap) - r;
      if (overlap <= 0) continue;
      s.worst_overlap = std::max(s.worst_overlap, (sum - r) / std::min(a.radius, b.radius));
      const Vec3 n = r > 0 ? (1 / r) * d : Vec3{k < j ? 1.0 : -1.0, 0, 0};
      push += (j < moving_ ? kPush : 2 * kPush) * overlap * n;
    }
    if (confined_[k] && push.x == 0 && push.y == 0 && push.z == 0) {  // at rest: nothing to ask, and most soon are
      next_[k] = a.position;
      return;
    }
    const double length = norm(push), most = 0.5 * a.radius;
    if (length > most) push = (most / length) * push;
    const Vec3 wanted = a.position + push;
    next_[k] = confine_(wanted, a.radius);
    confined_[k] = norm(next_[k] - wanted) <= 1e-9 * a.radius;
    s.longest_way = std::max(s.longest_way, norm(next_[k] - a.position));
  }

  size_t moving_;
  const Confine& confine_;
  std::span<PackedSphere> out_;
  std::vector<PackedSphere> all_;  // those that move, along the curve, then the fixed ones
  std::vector<uint32_t> order_;    // where each that moves came from
  std::vector<Vec3> next_;
  std::vector<uint8_t> confined_;  // confine() left it where it is
  std::vector<std::vector<uint32_t>> neighbours_;
  CellGrid grid_;
  std::vector<uint64_t> packed_, scratch_;
  double max_radius_ = 0, travel_ = 0;
};

}  // namespace

PackingOutcome push_apart(std::span<PackedSphere> spheres, std::span<const PackedSphere> fixed, const Confine& confine,
                          int max_iterations, const std::function<void(const PackingOutcome&)>& look) {
  return Packing(spheres, fixed, confine).run(max_iterations, look);
}

}  // namespace scree
