// Particle-particle contacts of one chunk: blocks of pairs through the contact law.
// Reads old particles, writes histories and adds to the chunk's force rows.
#pragma once

#include <algorithm>
#include <type_traits>

#include "kernels/contact_work.h"
#include "kernels/lane_bodies.h"
#include "kernels/periodic.h"

namespace scree {

// What the instantiation knows beforehand.
template <RollingModel rolling_model, bool is_uniform, bool has_ledger = false>
struct PassTraits {
  static constexpr RollingModel rolling = rolling_model;
  static constexpr bool uniform = is_uniform;
  static constexpr bool ledger = has_ledger;
};

// What a pass gives back beside forces and histories.
struct PassOutcome {
  double max_overlap = 0;  // pairs: share of the sum of the radii; solid: of the particle's radius
  StepLedger ledger;       // of its contacts, per second
};
template <class L, class Traits>
using WorkOf = std::conditional_t<Traits::ledger, BlockWork<typename L::Real>, NoWork>;

template <class L>
struct PairGeometry {
  Contact<typename L::F> contact;
  typename L::F arm_i, arm_j;
  typename L::F overlap_share;
};

template <class L, bool wraps>
[[gnu::always_inline]] inline PairGeometry<L> pair_geometry(const Bodies<L>& i, const Bodies<L>& j,
                                                            const StepSettings& settings) {
  using F = typename L::F;
  using D = typename L::D;
  Vec<D> d = i.position - j.position;
  if constexpr (wraps) d = minimum_image(d, settings.period, settings.inverse_period);
  const D distance2 = dot(d, d);
  const D radius_sum = L::widen(i.radius) + L::widen(j.radius);
  const F distance = sqrt(L::narrow(distance2));
  const F overlap = overlap_from<L>(radius_sum, distance2, distance);
  const F inverse_sum = F(1) / L::narrow(radius_sum);

  PairGeometry<L> g;
  g.contact.normal = (F(1) / distance) * narrow<L>(d);
  g.contact.overlap = overlap;
  g.contact.effective_radius = i.radius * j.radius * inverse_sum;
  g.contact.effective_mass = F(1) / (i.inverse_mass + j.inverse_mass);
  g.contact.velocity = i.velocity - j.velocity;
  g.arm_i = i.radius - F(0.5) * overlap;
  g.arm_j = j.radius - F(0.5) * overlap;
  g.contact.arm_spin = g.arm_i * i.spin + g.arm_j * j.spin;
  g.contact.rolling_spin = i.spin - j.spin;
  g.overlap_share = overlap * inverse_sum;
  return g;
}

template <class L, class Traits>
[[gnu::always_inline]] inline PairConstants<typename L::F> pair_constants_of(const ChunkTask<typename L::Real>& task,
                                                                             const uint16_t* i, const uint32_t* j) {
  using Real = typename L::Real;
  if constexpr (Traits::uniform) return broadcast_constants<L>(task.materials->row(0, 0));
  const Real* rows[L::width];
  for (int k = 0; k < L::width; ++k)
    rows[k] = task.materials->row(task.old_particles[task.begin + i[k]].kind(), task.old_particles[j[k]].kind());
  return gather_constants<L>(rows);
}

template <class F>
struct ForceTorque {
  Vec<F> force, torque;
};

// `width` contacts of a block, from `lane` on.
template <class L, bool wraps>
[[gnu::always_inline]] inline PairGeometry<L> pair_lanes(const ChunkTask<typename L::Real>& task,
                                                         const PairBlock<typename L::Real>& block, int lane) {
  return pair_geometry<L, wraps>(gather_bodies<L>(task.old_particles + task.begin, block.i + lane),
                                 gather_bodies<L>(task.old_particles, block.j + lane), *task.settings);
}

template <class F>
struct PairReaction {
  ForceTorque<F> on_i, on_j;
};

template <class L, class Traits>
[[gnu::always_inline]] inline PairReaction<typename L::F> react(const ChunkTask<typename L::Real>& task,
                                                                PairBlock<typename L::Real>& block, int lane,
                                                                PairGeometry<L>& g, typename L::F& max_share,
                                                                WorkOf<L, Traits>& work) {
  using F = typename L::F;
  const auto touching = g.contact.overlap > F(0);
  typename L::Real* stored = block.history[0] + lane;
  const Vec<F> zero{F(0), F(0), F(0)};
  if (!any(touching)) {
    store_history<L>(no_history<F>(), stored);
    return {{zero, zero}, {zero, zero}};
  }
  max_share = max(max_share, select(touching, g.overlap_share, F(0)));
  g.contact.overlap = max(g.contact.overlap, F(0));
  ContactHistory<F> history = load_history<L>(stored);
  const PairConstants<F> constants = pair_constants_of<L, Traits>(task, block.i + lane, block.j + lane);
  const Reaction<F> r = hertz_mindlin<Traits::rolling>(g.contact, constants, F(task.settings->history_dt),
                                                       task.settings->limit_attraction, history);
  store_history<L>(select_history(touching, history, no_history<F>()), stored);
  if constexpr (Traits::ledger) {
    typename L::Real share[L::width];  // the other chunk of a pair across two counts it, too
    for (int k = 0; k < L::width; ++k) share[k] = block.row[lane + k] == task.end - task.begin ? 0.5f : 1.0f;
    add_powers<L>(g.contact, r, L::load(share), touching, work, lane);
  }
  const Vec<F> force = select_vec(touching, r.force, zero);
  const Vec<F> lever = select_vec(touching, r.lever_torque, zero), rolling = select_vec(touching, r.rolling, zero);
  return {{force, fma(-g.arm_i, lever, -rolling)}, {-force, fma(-g.arm_j, lever, rolling)}};
}

// Blocks first..last - 1, a block in three stages: a contact is a chain of divisions and square roots, and vectors side
// by side in one stage fill each other's waits. The sixteen i rows first, then the sixteen j rows: the order of
// additions, and so the bits, are those of every lane width.
template <class L, class Traits, bool wraps>
inline void pair_pass(const ChunkTask<typename L::Real>& task, size_t first, size_t last, PassOutcome& outcome) {
  using F = typename L::F;
  constexpr int vectors = kBlock / L::width;
  F max_share(0);
  auto& blocks = task.contacts->blocks;
  const size_t count = blocks.size();
  for (size_t b = first; b < last; ++b) {
    if (b + 2 < count)  // the particles that the block after next will read
      for (int k = 0; k < kBlock; ++k) __builtin_prefetch(&task.old_particles[blocks[b + 2].j[k]]);
    PairGeometry<L> geometry[vectors];
    for (int k = 0; k < vectors; ++k) geometry[k] = pair_lanes<L, wraps>(task, blocks[b], k * L::width);
    PairReaction<F> reaction[vectors];
    WorkOf<L, Traits> work;
    for (int k = 0; k < vectors; ++k)
      reaction[k] = react<L, Traits>(task, blocks[b], k * L::width, geometry[k], max_share, work);
    if constexpr (Traits::ledger) work.add_to(outcome.ledger);
    for (int k = 0; k < vectors; ++k)
      add_to_rows<L>(task, blocks[b].i + k * L::width, reaction[k].on_i.force, reaction[k].on_i.torque);
    for (int k = 0; k < vectors; ++k)
      add_to_rows<L>(task, blocks[b].row + k * L::width, reaction[k].on_j.force, reaction[k].on_j.torque);
  }
  outcome.max_overlap = std::max<double>(outcome.max_overlap, L::max_lane(max_share));
}

template <class L, class Traits>
inline PassOutcome pair_pass(const ChunkTask<typename L::Real>& task) {
  PassOutcome outcome;
  const size_t count = task.contacts->blocks.size(), wrapping = std::min(count, task.contacts->first_wrapping);
  pair_pass<L, Traits, false>(task, 0, wrapping, outcome);
  if (wrapping < count) pair_pass<L, Traits, true>(task, wrapping, count, outcome);
  return outcome;
}

}  // namespace scree
