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

// Into `g`, not returned: a copy of it costs a tenth of the pass.
template <class L, bool wraps>
[[gnu::always_inline]] inline void pair_geometry(const Bodies<L>& i, const Bodies<L>& j, const StepSettings& settings,
                                                 PairGeometry<L>& g) {
  using F = typename L::F;
  using D = typename L::D;
  Vec<D> d = i.position - j.position;
  if constexpr (wraps) d = minimum_image(d, settings.period, settings.inverse_period);
  const D distance2 = dot(d, d);
  const D radius_sum = L::widen(i.radius) + L::widen(j.radius);
  const F distance = sqrt(L::narrow(distance2));
  const F overlap = overlap_from<L>(radius_sum, distance2, distance);
  const F inverse_sum = F(1) / L::narrow(radius_sum);

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

// `width` contacts of a block, from `lane` on.
template <class L, bool wraps>
[[gnu::always_inline]] inline void pair_lanes(const ChunkTask<typename L::Real>& task,
                                              const PairBlock<typename L::Real>& block, int lane,
                                              PairGeometry<L>& geometry) {
  pair_geometry<L, wraps>(gather_bodies<L>(task.old_particles + task.begin, block.i + lane),
                          gather_bodies<L>(task.old_particles, block.j + lane), *task.settings, geometry);
}

// A vector of contacts on its way through the law.
template <class L>
struct PairLaw {
  using F = typename L::F;
  decltype(F() > F()) touching;
  NormalResponse<F> normal;
  Vec<F> force, lever_torque, rolling;
};

template <class L, class Traits>
[[gnu::always_inline]] inline void normal_lanes(const ChunkTask<typename L::Real>& task,
                                                const PairBlock<typename L::Real>& block, int lane, PairGeometry<L>& g,
                                                PairLaw<L>& law, typename L::F& max_share) {
  using F = typename L::F;
  law.touching = g.contact.overlap > F(0);
  max_share = max(max_share, select(law.touching, g.overlap_share, F(0)));
  g.contact.overlap = max(g.contact.overlap, F(0));
  law.normal = hertz_normal(g.contact, pair_constants_of<L, Traits>(task, block.i + lane, block.j + lane),
                            task.settings->limit_attraction);
}

template <class L>
[[gnu::always_inline]] inline void friction_lanes(const ChunkTask<typename L::Real>& task,
                                                  PairBlock<typename L::Real>& block, int lane,
                                                  const PairGeometry<L>& g, PairLaw<L>& law) {
  using F = typename L::F;
  const Vec<F> zero{F(0), F(0), F(0)};
  typename L::Real* stored = block.history[0] + lane;
  Vec<F> xi = load_vec<L>(stored);
  const Vec<F> tangential = mindlin_friction(g.contact, law.normal, F(task.settings->history_dt), xi);
  store_vec<L>(select_vec(law.touching, xi, zero), stored);
  law.force = select_vec(law.touching, fma(law.normal.force, g.contact.normal, tangential), zero);
  law.lever_torque = select_vec(law.touching, cross(g.contact.normal, tangential), zero);
}

template <class L, class Traits>
[[gnu::always_inline]] inline void rolling_lanes(const ChunkTask<typename L::Real>& task,
                                                 PairBlock<typename L::Real>& block, int lane, const PairGeometry<L>& g,
                                                 PairLaw<L>& law) {
  using F = typename L::F;
  const Vec<F> zero{F(0), F(0), F(0)};
  typename L::Real* stored = block.history[3] + lane;
  Vec<F> torque = load_vec<L>(stored);
  const Vec<F> rolling =
      rolling_friction<Traits::rolling>(g.contact, pair_constants_of<L, Traits>(task, block.i + lane, block.j + lane),
                                        law.normal, F(task.settings->history_dt), torque);
  store_vec<L>(select_vec(law.touching, torque, zero), stored);
  law.rolling = select_vec(law.touching, rolling, zero);
}

template <class L>
inline void add_pair_powers(const ChunkTask<typename L::Real>& task, const PairBlock<typename L::Real>& block, int lane,
                            const PairGeometry<L>& g, const PairLaw<L>& law, BlockWork<typename L::Real>& work) {
  typename L::Real share[L::width];  // the other chunk of a pair across two counts it, too
  for (int k = 0; k < L::width; ++k) share[k] = block.row[lane + k] == task.end - task.begin ? 0.5f : 1.0f;
  add_powers<L>(g.contact, {law.force, law.lever_torque, law.rolling, law.normal.elastic}, L::load(share), law.touching,
                work, lane);
}

// Blocks first..last - 1, a block in stages: a contact is a chain of divisions and square roots, and vectors side by
// side in a stage short enough for the processor's window fill each other's waits. The sixteen i rows first, then the
// sixteen j rows: the order of additions, and so the bits, are those of every lane width.
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
    PairBlock<typename L::Real>& block = blocks[b];
    PairGeometry<L> geometry[vectors];
    PairLaw<L> law[vectors];
    for (int k = 0; k < vectors; ++k) pair_lanes<L, wraps>(task, block, k * L::width, geometry[k]);
    for (int k = 0; k < vectors; ++k)
      normal_lanes<L, Traits>(task, block, k * L::width, geometry[k], law[k], max_share);
    for (int k = 0; k < vectors; ++k) friction_lanes<L>(task, block, k * L::width, geometry[k], law[k]);
    for (int k = 0; k < vectors; ++k) rolling_lanes<L, Traits>(task, block, k * L::width, geometry[k], law[k]);
    if constexpr (Traits::ledger) {
      WorkOf<L, Traits> work;
      for (int k = 0; k < vectors; ++k) add_pair_powers<L>(task, block, k * L::width, geometry[k], law[k], work);
      work.add_to(outcome.ledger);
    }
    for (int k = 0; k < vectors; ++k)
      add_to_rows<L>(task, block.i + k * L::width, law[k].force,
                     nfms(geometry[k].arm_i, law[k].lever_torque, law[k].rolling));
    for (int k = 0; k < vectors; ++k)
      add_to_rows<L>(task, block.row + k * L::width, -law[k].force,
                     nfma(geometry[k].arm_j, law[k].lever_torque, law[k].rolling));
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
