#include "runtime/list_check.h"

#include <algorithm>
#include <cmath>

#include "geometry/bounds.h"
#include "kernels/cell_grid.h"
#include "kernels/parallel.h"
#include "kernels/periodic.h"

namespace scree {

namespace {

constexpr double kTouching = 1e-6;  // of the radii: less than this is a matter of rounding

uint64_t key(uint32_t a, uint32_t b) { return uint64_t{std::min(a, b)} << 32 | std::max(a, b); }
uint64_t solid_key(uint32_t i, int kind, uint32_t row) { return uint64_t{i} << 32 | uint32_t(kind) << 30 | row; }

// What one chunk lists, as sorted keys.
struct Listed {
  std::vector<uint64_t> pairs, solids;
};

bool holds(const std::vector<uint64_t>& keys, uint64_t key) {
  return std::binary_search(keys.begin(), keys.end(), key);
}

template <class Real>
void list_solids(const ChunkContacts<Real>& contacts, std::vector<uint64_t>& keys) {
  for (const SolidBlock& block : contacts.solid_blocks)
    for (uint32_t s = 0; s < block.slots(); ++s) {
      const int kind = s < block.segments ? 0 : s < uint32_t{block.segments} + block.quads ? 1 : 2;
      for (int lane = 0; lane < kBlock; ++lane)
        keys.push_back(
            solid_key(contacts.begin + block.i[lane], kind, contacts.slots[block.first_slot + s].primitive[lane]));
    }
}

template <class Real>
Listed listed(const ChunkContacts<Real>& contacts) {
  Listed all;
  for (uint32_t k = 0; k < contacts.pairs; ++k) {
    all.pairs.push_back(key(contacts.pair_i(k), contacts.pair_j(k)));
  }
  list_solids(contacts, all.solids);
  std::ranges::sort(all.pairs);
  std::ranges::sort(all.solids);
  return all;
}

// Particles by cell, by counting.
class Cells {
 public:
  Cells(const std::vector<Vec3>& positions, const Bounds& box, const double* period, double width) {
    Bounds bounds = empty_bounds();
    for (const Vec3& x : positions) bounds = united(bounds, {x, x});
    if (period[0] > 0) bounds.min.x = box.min.x;
    if (period[1] > 0) bounds.min.y = box.min.y;
    if (period[2] > 0) bounds.min.z = box.min.z;
    grid_.lay(bounds, period, width, std::max<size_t>(4096, 2 * positions.size()));
    begin_.assign(grid_.size() + 1, 0);
    for (const Vec3& x : positions) ++begin_[grid_.linear(grid_.cell_of(x)) + 1];
    for (size_t k = 1; k < begin_.size(); ++k) begin_[k] += begin_[k - 1];
    std::vector<uint32_t> next(begin_.begin(), begin_.end() - 1);
    order_.resize(positions.size());
    for (uint32_t k = 0; k < positions.size(); ++k) order_[next[grid_.linear(grid_.cell_of(positions[k]))]++] = k;
  }

  template <class Visit>
  void for_each_near(const Vec3& x, const Visit& visit) const {
    const auto cell = grid_.cell_of(x);
    for (int o = 0; o < 27; ++o) {
      std::array<uint32_t, 3> other;
      Vec3 shift;
      if (!grid_.neighbour(cell, {o % 3 - 1, o / 3 % 3 - 1, o / 9 - 1}, other, shift)) continue;
      const size_t at = grid_.linear(other);
      for (uint32_t k = begin_[at]; k < begin_[at + 1]; ++k) visit(order_[k]);
    }
  }

 private:
  CellGrid grid_;
  std::vector<uint32_t> begin_, order_;
};

template <class Real>
class Check {
 public:
  explicit Check(const ListCheckTask<Real>& task) : t_(task), positions_(wrapped(task)) {
    const uint64_t primitives = task.prepared ? task.prepared->size() : 0;
    if (task.count > task.brute_force_up_to || task.count * primitives > kMostLooksAtSolid)
      cells_.emplace(positions_, task.box, task.period, 2 * task.max_radius);
  }

  std::optional<MissingContact> run() const {
    std::vector<std::optional<MissingContact>> missing(t_.contacts->size());
    parallel_for(missing.size(), [&](size_t c) { missing[c] = run_chunk(c); });
    for (const auto& m : missing)
      if (m) return m;
    return std::nullopt;
  }

 private:
  // Between rebuilds particles may be a little outside a periodic box.
  static std::vector<Vec3> wrapped(const ListCheckTask<Real>& t) {
    std::vector<Vec3> positions(t.count);
    const auto wrap = [](double x, double low, double period) {
      return period > 0 ? x - period * std::floor((x - low) / period) : x;
    };
    for (uint32_t k = 0; k < t.count; ++k) {
      const Particle<Real>& p = t.particles[k];
      positions[k] = {wrap(p.x, t.box.min.x, t.period[0]), wrap(p.y, t.box.min.y, t.period[1]),
                      wrap(p.z, t.box.min.z, t.period[2])};
    }
    return positions;
  }

  double radius(uint32_t k) const { return static_cast<double>(t_.particles[k].radius); }

  std::optional<MissingContact> run_chunk(size_t c) const {
    const Listed lists = listed((*t_.contacts)[c]);
    const uint32_t begin = static_cast<uint32_t>(c) * t_.chunk_size, end = std::min(t_.count, begin + t_.chunk_size);
    for (uint32_t i = begin; i < end; ++i) {
      if (const auto pair = missing_pair(i, lists)) return pair;
      if (const auto solid = missing_solid(i, lists)) return solid;
    }
    return std::nullopt;
  }

  std::optional<MissingContact> missing_pair(uint32_t i, const Listed& lists) const {
    std::optional<MissingContact> missing;
    const auto look = [&](uint32_t j) {
      if (j == i || missing) return;
      const double sum = radius(i) + radius(j);
      const Vec3 d = minimum_image(positions_[i] - positions_[j], t_.period, t_.inverse_period);
      if (dot(d, d) >= sum * sum) return;
      const double overlap = sum - norm(d);
      if (overlap > kTouching * sum && !holds(lists.pairs, key(i, j))) missing = MissingContact{i, j, 0, 0, overlap};
    };
    if (cells_)
      cells_->for_each_near(positions_[i], look);
    else
      for (uint32_t j = 0; j < t_.count; ++j) look(j);
    return missing;
  }

  // As the index answers, without it.
  void look_at_every_primitive(const Vec3& x, double reach, std::vector<uint32_t>& touching) const {
    for (uint32_t k = 0; k < t_.prepared->size(); ++k)
      if (distance((*t_.prepared)[k], x) <= reach) touching.push_back(k);
  }

  std::optional<MissingContact> missing_solid(uint32_t i, const Listed& lists) const {
    if (!t_.index) return std::nullopt;
    thread_local std::vector<uint32_t> touching;
    touching.clear();
    const Vec3 x{t_.particles[i].x, t_.particles[i].y, t_.particles[i].z};  // images reach beyond the borders
    const double reach = (1 - kTouching) * radius(i);
    if (cells_)
      t_.index->query(x, reach, touching);
    else
      look_at_every_primitive(x, reach, touching);
    for (const uint32_t primitive : touching) {
      const int kind = t_.tables->kind[primitive];
      const uint32_t row = t_.tables->row[primitive];
      if (!holds(lists.solids, solid_key(i, kind, row))) return MissingContact{i, std::nullopt, kind, row, 0};
    }
    return std::nullopt;
  }

  const ListCheckTask<Real>& t_;
  std::vector<Vec3> positions_;
  std::optional<Cells> cells_;  // none: by brute force
};

}  // namespace

template <class Real>
std::optional<MissingContact> find_missing_contact(const ListCheckTask<Real>& task) {
  return task.count > 0 ? Check<Real>(task).run() : std::nullopt;
}

template std::optional<MissingContact> find_missing_contact(const ListCheckTask<float>&);
template std::optional<MissingContact> find_missing_contact(const ListCheckTask<double>&);

}  // namespace scree
