#include "kernels/solid_search.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace scree {

namespace {

// What lies near one particle: rows of each kind's table, in the order of the case's list.
struct Neighbourhood {
  uint32_t particle;
  uint32_t first;  // into Search::found
  uint8_t counts[3];
};

template <class Real>
class Search {
 public:
  explicit Search(const SolidSearchTask<Real>& task) : t_(task), buried_(task.count) {}

  SolidSearchOutcome run() {
    for (uint32_t first = t_.begin; first < t_.end;) {
      const uint32_t last = std::min(t_.end, t_.grid->ranges[t_.grid->linear(t_.grid->cell_of(position(first)))].end);
      if (const uint32_t bad = search_cell(first, last); bad != t_.count) return {bad, buried_, buried_in_};
      first = last;
    }
    // Particles with equally many neighbours share a block, so few slots are padding.
    std::stable_sort(near_.begin(), near_.end(), [](const Neighbourhood& a, const Neighbourhood& b) {
      return std::lexicographical_compare(b.counts, b.counts + 3, a.counts, a.counts + 3);
    });
    for (size_t k = 0; k < near_.size();) {
      const size_t end = end_of_block(k);
      lay_block(k, end);
      k = end;
    }
    return {t_.count, buried_, buried_in_};
  }

 private:
  size_t end_of_block(size_t begin) const {
    uint32_t most[3] = {0, 0, 0};
    size_t k = begin;
    for (; k < std::min(near_.size(), begin + kBlock); ++k) {
      for (int kind = 0; kind < 3; ++kind) most[kind] = std::max<uint32_t>(most[kind], near_[k].counts[kind]);
      if (most[0] + most[1] + most[2] > kMaxSlots) break;
    }
    return k;
  }
  Vec3 position(uint32_t k) const { return {t_.particles[k].x, t_.particles[k].y, t_.particles[k].z}; }

  // One query for the particles of a cell, then the exact distance for each.
  uint32_t search_cell(uint32_t first, uint32_t last) {
    Vec3 low = position(first), high = low;
    double radius = 0;
    for (uint32_t k = first; k < last; ++k) {
      const Vec3 x = position(k);
      low = {std::min(low.x, x.x), std::min(low.y, x.y), std::min(low.z, x.z)};
      high = {std::max(high.x, x.x), std::max(high.y, x.y), std::max(high.z, x.z)};
      radius = std::max(radius, static_cast<double>(t_.particles[k].radius));
    }
    cell_.clear();
    t_.index->query(0.5 * (low + high), (0.5 * norm(high - low) + radius + t_.skin) * (1 + 1e-12), cell_);
    if (cell_.empty()) return t_.count;
    for (uint32_t k = first; k < last; ++k)
      if (!search_particle(k)) return k;
    return t_.count;
  }

  bool search_particle(uint32_t k) {
    Neighbourhood n{k, static_cast<uint32_t>(found_.size()), {0, 0, 0}};
    const double radius = static_cast<double>(t_.particles[k].radius), reach = radius + t_.skin;
    for (int kind = 0; kind < 3; ++kind)
      for (const uint32_t primitive : cell_) {
        if (t_.tables->kind[primitive] != kind) continue;
        const double off = distance((*t_.prepared)[primitive], position(k));
        if (off < t_.least_distance * radius && buried_ == t_.count) buried_ = k, buried_in_ = primitive;
        if (off <= reach) {
          found_.push_back(t_.tables->row[primitive]);
          if (found_.size() - n.first > kMaxSlots) return false;
          ++n.counts[kind];
        }
      }
    if (found_.size() > n.first) near_.push_back(n);
    return true;
  }

  void lay_block(size_t begin, size_t end) {
    SolidBlock block{};
    uint8_t slots[3] = {0, 0, 0};
    for (size_t k = begin; k < end; ++k) {
      block.i[k - begin] = static_cast<uint16_t>(near_[k].particle - t_.begin);
      for (int kind = 0; kind < 3; ++kind) slots[kind] = std::max(slots[kind], near_[k].counts[kind]);
    }
    block.segments = slots[0], block.quads = slots[1], block.revolutions = slots[2];
    block.first_slot = static_cast<uint32_t>(t_.contacts->slots.size());
    t_.contacts->solid_blocks.push_back(block);
    const uint32_t dummies[3] = {t_.tables->segments.dummy(), t_.tables->quads.dummy(), t_.tables->revolutions.dummy()};
    uint32_t before[kBlock] = {};
    for (int kind = 0; kind < 3; ++kind) {
      for (uint8_t s = 0; s < slots[kind]; ++s) {
        SolidSlot<Real>& slot = t_.contacts->slots.emplace_back();
        std::fill(slot.primitive, slot.primitive + kBlock, dummies[kind]);
        for (size_t k = begin; k < end; ++k)
          if (s < near_[k].counts[kind])
            fill_lane(slot, static_cast<int>(k - begin), kind, near_[k], before[k - begin] + s);
      }
      for (size_t k = begin; k < end; ++k) before[k - begin] += near_[k].counts[kind];
    }
  }

  void fill_lane(SolidSlot<Real>& slot, int lane, int kind, const Neighbourhood& n, uint32_t at) {
    const uint32_t row = found_[n.first + at];
    slot.primitive[lane] = row;
    if (t_.history->copy_solid(t_.old_index[n.particle], t_.tables->identity(kind, row), slot.history[0] + lane))
      slot.live |= 1u << lane;
  }

  const SolidSearchTask<Real>& t_;
  std::vector<uint32_t> cell_, found_;
  std::vector<Neighbourhood> near_;
  uint32_t buried_, buried_in_ = 0;
};

}  // namespace

template <class Real>
SolidSearchOutcome search_solid(const SolidSearchTask<Real>& task) {
  return Search<Real>(task).run();
}

template SolidSearchOutcome search_solid(const SolidSearchTask<float>&);
template SolidSearchOutcome search_solid(const SolidSearchTask<double>&);

}  // namespace scree
