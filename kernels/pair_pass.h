// Particle-particle contacts of one chunk: blocks of pairs through the contact law.
// Reads old particles, writes histories and adds to the chunk's force rows. Returns the largest overlap as a share of
// the sum of the radii.
#pragma once

#include "kernels/lane_bodies.h"
#include "kernels/periodic.h"

namespace scree {

// What the instantiation knows beforehand.
template <RollingModel rolling_model, bool is_uniform, bool is_periodic>
struct PassTraits {
  static constexpr RollingModel rolling = rolling_model;
  static constexpr bool uniform = is_uniform;
  static constexpr bool periodic = is_periodic;
};

template <class L>
struct PairGeometry {
  Contact<typename L::F> contact;
  typename L::F arm_i, arm_j;
  typename L::F overlap_share;
};

template <class L, bool periodic>
[[gnu::always_inline]] inline PairGeometry<L> pair_geometry(const Bodies<L>& i, const Bodies<L>& j,
                                                            const StepSettings& settings) {
  using F = typename L::F;
  using D = typename L::D;
  Vec<D> d = i.position - j.position;
  if constexpr (periodic) d = minimum_image(d, settings.period);
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
                                                                             const uint32_t* i, const uint32_t* j) {
  using Real = typename L::Real;
  if constexpr (Traits::uniform) return broadcast_constants<L>(task.materials->row(0, 0));
  const Real* rows[L::width];
  for (int k = 0; k < L::width; ++k)
    rows[k] = task.materials->row(task.old_particles[i[k]].kind(), task.old_particles[j[k]].kind());
  return gather_constants<L>(rows);
}

template <class F>
struct ForceTorque {
  Vec<F> force, torque;
};

// `width` contacts from `lane` on. Adds to the rows of i; returns what is for j.
template <class L, class Traits>
[[gnu::always_inline]] inline ForceTorque<typename L::F> pair_lanes(const ChunkTask<typename L::Real>& task,
                                                                    PairBlock<typename L::Real>& block, int lane,
                                                                    typename L::F& max_share) {
  using F = typename L::F;
  const uint32_t *index_i = block.i + lane, *index_j = block.j + lane;
  const Bodies<L> i = gather_bodies<L>(task.old_particles, index_i), j = gather_bodies<L>(task.old_particles, index_j);
  PairGeometry<L> g = pair_geometry<L, Traits::periodic>(i, j, *task.settings);
  const auto touching = g.contact.overlap > F(0);
  typename L::Real* stored = block.history[0] + lane;
  const Vec<F> zero{F(0), F(0), F(0)};
  if (!any(touching)) {
    store_history<L>(no_history<F>(), stored);
    return {zero, zero};
  }
  max_share = max(max_share, select(touching, g.overlap_share, F(0)));
  g.contact.overlap = max(g.contact.overlap, F(0));
  ContactHistory<F> history = load_history<L>(stored);
  const PairConstants<F> constants = pair_constants_of<L, Traits>(task, index_i, index_j);
  const Reaction<F> r = hertz_mindlin<Traits::rolling>(g.contact, constants, F(task.settings->history_dt),
                                                       task.settings->limit_attraction, history);
  store_history<L>(select_history(touching, history, no_history<F>()), stored);
  const Vec<F> force = select_vec(touching, r.force, zero);
  const Vec<F> lever = select_vec(touching, r.lever_torque, zero), rolling = select_vec(touching, r.rolling, zero);
  add_to_rows<L>(task, index_i, force, -(g.arm_i * lever) - rolling);
  return {-force, rolling - g.arm_j * lever};
}

// A block's sixteen i rows first, then its sixteen j rows: the order of additions, and so the bits, are those of every
// lane width.
template <class L, class Traits>
inline double pair_pass(const ChunkTask<typename L::Real>& task) {
  using F = typename L::F;
  F max_share(0);
  auto& blocks = task.contacts->blocks;
  const size_t count = blocks.size();
  for (size_t b = 0; b < count; ++b) {
    if (b + 2 < count)  // the particles that the block after next will read
      for (int k = 0; k < kBlock; ++k) __builtin_prefetch(&task.old_particles[blocks[b + 2].j[k]]);
    ForceTorque<F> on_j[kBlock / L::width];
    for (int k = 0; k < kBlock / L::width; ++k)
      on_j[k] = pair_lanes<L, Traits>(task, blocks[b], k * L::width, max_share);
    for (int k = 0; k < kBlock / L::width; ++k)
      add_to_rows<L>(task, blocks[b].j + k * L::width, on_j[k].force, on_j[k].torque);
  }
  return L::max_lane(max_share);
}

}  // namespace scree
