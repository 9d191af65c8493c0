// Whether what a checkpoint brought is a state of this case. The seal has found damage before (runtime/seal.h); what is
// refused here was written by another program or under another layout. Everything that is used as an index, a size or a
// divisor is looked at, so that nothing that loads can crash a step.
#include <algorithm>
#include <cmath>

#include "kernels/parallel.h"
#include "runtime/domain.h"
#include "runtime/state_archive.h"

namespace scree {

namespace {

constexpr double kRounding = 1 + 1e-6;  // radii are kept in Real, their largest in double

bool all_finite(std::initializer_list<double> values) {
  return std::ranges::all_of(values, [](double v) { return std::isfinite(v); });
}

// Pairs and solids of one chunk of the old order, `rows` particles.
template <class Real>
bool is_sound(const ChunkHistory<Real>& history, uint32_t rows) {
  return history.first.size() > rows && history.first.back() <= history.entries.size() &&
         std::ranges::is_sorted(history.first);
}

template <class Real>
bool pairs_are_sound(const ChunkContacts<Real>& c, uint32_t count, size_t chunks) {
  const uint32_t size = c.end - c.begin;
  for (const double d : {c.inner, c.middle, c.near_closing, c.far_closing})
    if (!std::isfinite(d) || d < 0) return false;
  if (std::ranges::any_of(c.beside, [&](uint32_t b) { return b >= chunks; })) return false;
  if (c.blocks.size() != (size_t{c.pairs} + kBlock - 1) / kBlock) return false;
  for (const PairBlock<Real>& b : c.blocks)
    for (int k = 0; k < kBlock; ++k) {
      const uint32_t j = b.j[k], row = j >= c.begin && j < c.end ? j - c.begin : size;
      if (b.i[k] >= size || j > count || b.row[k] != row) return false;
    }
  for (uint32_t k = 0; k < c.pairs; ++k)
    if (c.pair_j(k) >= count) return false;
  const auto ours = [&](const WaitingPair& w) { return w.i >= c.begin && w.i < c.end && w.j < count && w.i != w.j; };
  return std::ranges::all_of(c.near, ours) && std::ranges::all_of(c.far, ours);
}

template <class Real>
bool solids_are_sound(const ChunkContacts<Real>& c, const SolidTables<Real>& tables) {
  const size_t rows[] = {tables.segments.rows.size(), tables.quads.rows.size(), tables.revolutions.rows.size()};
  for (const SolidBlock& b : c.solid_blocks) {
    if (b.slots() > kMaxSlots || size_t{b.first_slot} + b.slots() > c.slots.size()) return false;
    if (std::ranges::any_of(b.i, [&](uint16_t i) { return i >= c.end - c.begin; })) return false;
    for (uint32_t s = 0; s < b.slots(); ++s) {
      const size_t most = rows[s < b.segments ? 0 : s < uint32_t{b.segments} + b.quads ? 1 : 2];
      const SolidSlot<Real>& slot = c.slots[b.first_slot + s];
      for (int lane = 0; lane < kBlock; ++lane) {
        const bool dummy = slot.primitive[lane] + size_t{1} == most;  // has no identity, so no history either
        if (slot.primitive[lane] >= most || (dummy && (slot.live >> lane & 1u))) return false;
      }
    }
  }
  return true;
}

}  // namespace

template <class Real>
void Domain<Real>::require_sound_numbers() const {
  require_state(chunk_size_ >= 1 && chunk_size_ <= kChunk, "its chunks have no possible size");
  require_state(all_finite({max_radius_, min_radius_, max_speed_, max_overlap_, skin_, travel_}) && min_radius_ >= 0 &&
                    max_radius_ >= min_radius_ && max_speed_ >= 0 && max_overlap_ >= 0 && skin_ >= 0 && travel_ >= 0,
                "a radius, speed, overlap, skin or way is negative or not a number");
  require_state(next_id_ <= counters_.inserted, "more particles have numbers than went in");
  for (const double period : settings_.period)
    require_state(period == 0 || 2 * max_radius_ < period, "a particle is larger than half a periodic axis");
  require_state(std::ranges::is_sorted(solid_identity_, std::less_equal{}) &&
                    (solid_identity_.empty() || solid_identity_.back() < solid_.primitives.size()),
                "its list of fibres and walls names others");
}

template <class Real>
void Domain<Real>::require_sound_particles() const {
  for (uint32_t k = 0; k < count_; ++k) {
    const Particle<Real>& p = now_[k];
    require_state(all_finite({p.x, p.y, p.z, p.vx, p.vy, p.vz, p.wx, p.wy, p.wz, p.inverse_mass}),
                  "a particle's position, velocity or mass is not a number");
    require_state(p.radius > 0 && p.radius <= max_radius_ * kRounding && p.inverse_mass > 0 && p.kind() < kinds_,
                  "a particle has an impossible radius, mass or kind");
    require_state(p.id() < next_id_, "a particle's number is one that none was given");
  }
}

template <class Real>
void Domain<Real>::require_sound_history() const {
  const HistoryTable<Real>& h = history_;
  require_state(h.chunk_size >= 1 && h.pairs.size() == h.solids.size() && h.count <= h.pairs.size() * h.chunk_size,
                "its contact histories do not fit its particles");
  for (size_t c = 0; c * h.chunk_size < h.count; ++c) {
    const auto rows = static_cast<uint32_t>(std::min<size_t>(h.chunk_size, h.count - c * h.chunk_size));
    require_state(is_sound(h.pairs[c], rows) && is_sound(h.solids[c], rows),
                  "its contact histories do not fit its particles");
  }
}

template <class Real>
void Domain<Real>::require_sound_lists() const {
  require_state(contacts_.size() == chunks(), "its contact lists do not fit its particles");
  std::vector<uint8_t> sound(contacts_.size());
  parallel_for(contacts_.size(), [&](size_t c) {
    const ChunkContacts<Real>& list = contacts_[c];
    sound[c] = list.begin == chunk_begin(c) && list.end == chunk_end(c) && list.dummy == count_ &&
               pairs_are_sound(list, count_, contacts_.size()) && solids_are_sound(list, tables_);
  });
  require_state(std::ranges::all_of(sound, [](uint8_t s) { return s != 0; }),
                "its contact lists name particles or primitives that are not there");
}

template class Domain<float>;
template class Domain<double>;

}  // namespace scree
