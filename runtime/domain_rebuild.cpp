// The domain's list rebuild: sort the particles, find the pairs and the solid near them, carry the histories over.
#include <algorithm>
#include <atomic>
#include <cmath>

#include <fmt/format.h>

#include "geometry/bounds.h"
#include "kernels/parallel.h"
#include "kernels/radix_sort.h"
#include "kernels/solid_search.h"
#include "runtime/domain.h"
#include "runtime/timer.h"

namespace scree {

namespace {

// Sizes of the lists in units of the largest radius, from the largest speed seen; measured on settled beds and drains.
// The outer skin lasts kStepsPerRebuild steps at that speed. The inner one weighs the pairs that are evaluated without
// touching (more with a wider skin) against the checks of those that wait (more often with a narrower one): the best
// grows with the square root of the way per step.
constexpr double kStepsPerRebuild = 60, kSkinLeast = 0.2, kSkinMost = 1.2;
constexpr double kInnerPerRootWay = 0.2, kInnerLeast = 0.004, kInnerMost = 0.1;
constexpr double kMiddleShare = 0.6;  // between `near` and `far`, of the inner and the outer skin's geometric mean
constexpr uint32_t kSmallestChunk = 256;
constexpr uint32_t kWantedChunks = 64;  // small runs get smaller chunks, so that several threads find work

}  // namespace

template <class Real>
void Domain<Real>::index_solid() {
  const double reach = max_radius_ * (1 + 2 * kSkinMost) + 2 * fixed_skin_;
  ImagedSolid imaged = with_periodic_images(solid_, box_, periodic_, reach);
  for (uint32_t& id : imaged.identity) id = solid_identity_[id];
  tables_ = make_solid_tables<Real>(imaged, kinds_);
  prepared_.clear();
  for (const Primitive& p : imaged.solid.primitives) prepared_.push_back(prepared(p));
  index_ = brute_force_solid_ ? make_brute_force_index(imaged.solid) : make_embree_index(imaged.solid);
}

template <class Real>
void Domain<Real>::rebuild() {
  invalidate_lists();
  if (!index_) index_solid();
  choose_skin();
  {
    Timer t(counters_.sort_seconds);
    check_and_wrap();
    sort_particles();
    mark_ranges();
  }
  search_pairs();
  search_solids();
  history_.count = 0;
  travel_ = 0;
  lists_valid_ = true;
  ++counters_.rebuilds;
}

template <class Real>
void Domain<Real>::choose_skin() {
  if (count_ == 0) return;
  const double way = 2 * max_speed_ * settings_.dt / max_radius_;  // two particles' in a step, in radii
  skin_ = fixed_skin_ > 0 ? fixed_skin_ : std::clamp(kStepsPerRebuild * way, kSkinLeast, kSkinMost) * max_radius_;
  for (const double period : settings_.period)
    if (period > 0) skin_ = std::min(skin_, 0.4999 * period - 2 * max_radius_);
  if (skin_ <= 0) throw RunError("a periodic axis is shorter than twice the largest diameter");
}

// The gaps that tell a chunk's lists of pairs apart, from the fastest of its particles.
template <class Real>
void Domain<Real>::choose_gaps(size_t chunk) {
  double speed2 = 0;
  for (uint32_t k = chunk_begin(chunk); k < chunk_end(chunk); ++k) {
    const Particle<Real>& p = now_[k];
    const Vec<double> v{p.vx, p.vy, p.vz};
    speed2 = std::max(speed2, dot(v, v));
  }
  ChunkContacts<Real>& list = contacts_[chunk];
  const double way = 2 * std::sqrt(speed2) * settings_.dt / max_radius_;
  list.inner = std::min(std::clamp(kInnerPerRootWay * std::sqrt(way), kInnerLeast, kInnerMost) * max_radius_, skin_);
  list.middle = std::max(list.inner, kMiddleShare * std::sqrt(list.inner * skin_));
}

template <class Real>
void Domain<Real>::find_chunks_beside(size_t chunk) {
  std::vector<uint32_t>& beside = contacts_[chunk].beside;
  uint32_t last = static_cast<uint32_t>(chunk);
  for (const auto* list : {&contacts_[chunk].near, &contacts_[chunk].far})
    for (const WaitingPair& pair : *list) {
      const uint32_t other = pair.j / chunk_size_;
      if (other == chunk || other == last) continue;
      last = other;
      if (std::find(beside.begin(), beside.end(), other) == beside.end()) beside.push_back(other);
    }
}

// Takes the histories out of the lists; they wait in history_ for the next rebuild.
template <class Real>
void Domain<Real>::invalidate_lists() {
  if (lists_valid_) gather_histories();
  lists_valid_ = false;
}

template <class Real>
void Domain<Real>::gather_histories() {
  Timer t(counters_.history_seconds);
  history_.chunk_size = chunk_size_, history_.count = contacts_.empty() ? 0 : chunk_end(contacts_.size() - 1);
  history_.pairs.resize(contacts_.size()), history_.solids.resize(contacts_.size());
  parallel_for(contacts_.size(), [&](size_t c) {
    const uint32_t size = contacts_[c].end - contacts_[c].begin;
    history_.pairs[c].gather(size, [&](const auto& visit) { list_live_pairs(contacts_[c], visit); });
    const auto identity = [&](int kind, uint32_t row) { return tables_.identity(kind, row); };
    history_.solids[c].gather(size, [&](const auto& visit) { list_live_solids(contacts_[c], identity, visit); });
    contacts_[c].clear(0, 0, 0);
  });
}

// Wraps positions round periodic borders, refuses particles outside the domain that no outlet explains.
template <class Real>
void Domain<Real>::check_and_wrap() {
  std::atomic<uint32_t> lost{count_};
  parallel_for_each(count_, [&](size_t k) {
    Particle<Real>& p = now_[k];
    double* x[3] = {&p.x, &p.y, &p.z};
    const double low[3] = {box_.min.x, box_.min.y, box_.min.z}, high[3] = {box_.max.x, box_.max.y, box_.max.z};
    bool outside = false;
    for (int a = 0; a < 3; ++a) {
      if (periodic_[a])
        *x[a] -= settings_.period[a] * std::floor((*x[a] - low[a]) / settings_.period[a]);
      else
        outside |= !(*x[a] >= low[a] && *x[a] <= high[a]);
    }
    if (outside && !(leaves_ && leaves_(state_of(p)) >= 0)) lost = static_cast<uint32_t>(k);
  });
  if (lost < count_) {
    const ParticleState s = state(lost);
    throw RunError(
        fmt::format("particle {} left the domain at ({:.6g}, {:.6g}, {:.6g}) m, t = {:.6g} s, speed {:.4g} m/s, not "
                    "through an outlet. "
                    "Close the gap in the walls, enlarge [domain], or add an [[outlet]] there.",
                    s.id, s.position.x, s.position.y, s.position.z, time(), norm(s.velocity)),
        s.position);
  }
}

// The bounding box of the particles; along periodic axes it begins where the domain does.
template <class Real>
Bounds Domain<Real>::occupied_bounds() const {
  if (count_ == 0) return box_;
  std::vector<Bounds> partial((count_ + kChunk - 1) / kChunk, empty_bounds());
  parallel_for(partial.size(), [&](size_t c) {
    for (size_t k = c * kChunk; k < std::min<size_t>(count_, (c + 1) * kChunk); ++k) {
      const Vec3 x{now_[k].x, now_[k].y, now_[k].z};
      partial[c] = united(partial[c], {x, x});
    }
  });
  Bounds all = empty_bounds();
  for (const Bounds& b : partial) all = united(all, b);
  if (periodic_[0]) all.min.x = box_.min.x;
  if (periodic_[1]) all.min.y = box_.min.y;
  if (periodic_[2]) all.min.z = box_.min.z;
  return all;
}

// Counts the particles that the removal rule takes out; returns their marks.
template <class Real>
std::vector<uint8_t> Domain<Real>::take_out_leavers() {
  if (!leaves_) return {};
  std::vector<int> where(count_);
  parallel_for_each(count_, [&](size_t k) { where[k] = leaves_(state(k)); });
  std::vector<uint8_t> gone(count_);
  for (size_t k = 0; k < count_; ++k) {
    if (where[k] < 0) continue;
    gone[k] = 1, ++counters_.removed;
    if (counters_.removed_mass.size() <= static_cast<size_t>(where[k]))
      counters_.removed_mass.resize(where[k] + 1, 0.0);
    const ParticleState s = state(k);
    counters_.removed_mass[where[k]] += s.mass;
    book(counters_.ledger.removed_kinetic, counters_.ledger.removed_potential, counters_.ledger.removed_momentum, s);
  }
  return gone;
}

template <class Real>
void Domain<Real>::sort_particles() {
  const std::vector<uint8_t> gone = take_out_leavers();
  const Vec3 size = box_.max - box_.min;
  const double cell = max_radius_ > 0 ? 2 * max_radius_ + skin_ : std::max({size.x, size.y, size.z});
  grid_.lay(occupied_bounds(), settings_.period, cell, std::max<size_t>(4096, size_t{4} * count_));

  packed_.resize(count_);
  parallel_for_each(count_, [&](size_t k) {
    packed_[k] = uint64_t{grid_.morton(grid_.cell_of({now_[k].x, now_[k].y, now_[k].z}))} << 32 | k;
  });
  if (!gone.empty()) std::erase_if(packed_, [&](uint64_t p) { return gone[p & 0xffffffffu]; });
  radix_sort(packed_, packed_scratch_, grid_.morton_bits());

  count_ = static_cast<uint32_t>(packed_.size());
  old_index_.resize(count_);
  parallel_for_each(count_, [&](size_t k) {
    old_index_[k] = static_cast<uint32_t>(packed_[k]);
    next_[k] = now_[old_index_[k]];
  });
  now_.swap(next_);
  place_dummies(now_), place_dummies(next_);
  chunk_size_ = std::clamp((count_ / kWantedChunks + 63) / 64 * 64, kSmallestChunk, kChunk);
}

template <class Real>
void Domain<Real>::mark_ranges() {
  parallel_for_each(count_, [&](size_t k) {
    const uint32_t code = static_cast<uint32_t>(packed_[k] >> 32);
    CellGrid::Range& range = grid_.ranges[grid_.linear(grid_.cell_of({now_[k].x, now_[k].y, now_[k].z}))];
    if (k == 0 || static_cast<uint32_t>(packed_[k - 1] >> 32) != code) range.begin = static_cast<uint32_t>(k);
    if (k + 1 == count_ || static_cast<uint32_t>(packed_[k + 1] >> 32) != code)
      range.end = static_cast<uint32_t>(k + 1);
  });
}

template <class Real>
void Domain<Real>::search_pairs() {
  Timer t(counters_.pair_search_seconds);
  contacts_.resize(chunks());
  outcomes_.resize(chunks());
  parallel_for(chunks(), [&](size_t c) {
    contacts_[c].clear(chunk_begin(c), chunk_end(c), count_);
    choose_gaps(c);
    kernels_.search({now_.data(), chunk_begin(c), chunk_end(c), count_, &grid_, skin_, contacts_[c].middle,
                     contacts_[c].inner, old_index_.data(), &history_, &contacts_[c]});
    find_chunks_beside(c);
  });
}

template <class Real>
void Domain<Real>::search_solids() {
  Timer t(counters_.solid_search_seconds);
  if (solid_.primitives.empty()) return;
  const double solid_reach = 0.5 * skin_;  // the solid stands still: a particle comes no nearer than its own way
  std::vector<SolidSearchOutcome> outcomes(chunks());
  parallel_for(chunks(), [&](size_t c) {
    outcomes[c] =
        search_solid<Real>({now_.data(), chunk_begin(c), chunk_end(c), count_, &grid_, solid_reach, index_.get(),
                            &prepared_, &tables_, old_index_.data(), &history_, &contacts_[c], kBuriedShare});
  });
  for (const SolidSearchOutcome& o : outcomes) {
    if (o.buried != count_) fail_buried(o.buried, o.buried_in);
    if (o.crowded != count_) fail_crowded(o.crowded);
  }
}

template <class Real>
void Domain<Real>::fail_crowded(uint32_t particle) const {
  const ParticleState s = state(particle);
  throw RunError(
      fmt::format("particle {} of radius {:.4g} m at ({:.6g}, {:.6g}, {:.6g}) m has more than {} fibres and "
                  "walls within {:.4g} "
                  "m; use smaller particles, a coarser fibre network, or a smaller [neighbour] skin",
                  s.id, s.radius, s.position.x, s.position.y, s.position.z, kMaxSlots, s.radius + 0.5 * skin_),
      s.position);
}

template class Domain<float>;
template class Domain<double>;

}  // namespace scree
