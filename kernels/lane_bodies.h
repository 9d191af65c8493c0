// Particles read into lanes, and what kinematics pairs and walls share.
#pragma once

#include <cstdint>

#include "kernels/chunk_task.h"
#include "kernels/simd.h"

namespace scree {

template <class L>
struct Bodies {
  Vec<typename L::D> position;
  Vec<typename L::F> velocity, spin;
  typename L::F radius, inverse_mass;
};

template <class L, class Index>
[[gnu::always_inline]] inline Bodies<L> gather_bodies(const Particle<typename L::Real>* particles, const Index* index) {
  using Real = typename L::Real;
  const double* positions[L::width];
  const Real* motions[L::width];
  for (int k = 0; k < L::width; ++k) {
    const Particle<Real>& p = particles[index[k]];
    positions[k] = &p.x;
    motions[k] = &p.vx;
  }
  typename L::D d[4];
  typename L::F f[8];
  L::load_double_rows(positions, d);
  L::load_rows(motions, f);
  return {{d[0], d[1], d[2]}, {f[0], f[1], f[2]}, {f[3], f[4], f[5]}, f[6], f[7]};
}

// Material constants of each lane: one broadcast for a uniform table, else rows chosen by kind and column.
template <class L>
[[gnu::always_inline]] inline PairConstants<typename L::F> broadcast_constants(const typename L::Real* row) {
  using F = typename L::F;
  return {F(row[0]), F(row[1]), F(row[2]), F(row[3]), F(row[4]), F(row[5])};
}
template <class L>
[[gnu::always_inline]] inline PairConstants<typename L::F> gather_constants(const typename L::Real* const* rows) {
  typename L::F f[8];
  L::load_rows(rows, f);
  return {f[0], f[1], f[2], f[3], f[4], f[5]};
}

template <class L>
[[gnu::always_inline]] inline Vec<typename L::F> narrow(const Vec<typename L::D>& a) {
  return {L::narrow(a.x), L::narrow(a.y), L::narrow(a.z)};
}

// Overlap of two spheres from their squared distance without cancellation (engine.md, point 6):
// R - r = (R^2 - r^2) / (R + r), the numerator in double, R the sum of the radii formed in double.
template <class L>
[[gnu::always_inline]] inline typename L::F overlap_from(const typename L::D& radius_sum,
                                                         const typename L::D& distance2,
                                                         const typename L::F& distance) {
  return L::narrow(fma(radius_sum, radius_sum, -distance2)) / (L::narrow(radius_sum) + distance);
}

// Three rows of a block's history.
template <class L>
[[gnu::always_inline]] inline Vec<typename L::F> load_vec(const typename L::Real* h) {
  return {L::load(h), L::load(h + kBlock), L::load(h + 2 * kBlock)};
}
template <class L>
[[gnu::always_inline]] inline void store_vec(const Vec<typename L::F>& v, typename L::Real* h) {
  L::store(v.x, h), L::store(v.y, h + kBlock), L::store(v.z, h + 2 * kBlock);
}

template <class L>
[[gnu::always_inline]] inline ContactHistory<typename L::F> load_history(const typename L::Real* h) {
  return {load_vec<L>(h), load_vec<L>(h + 3 * kBlock)};
}
template <class L>
[[gnu::always_inline]] inline void store_history(const ContactHistory<typename L::F>& h, typename L::Real* p) {
  store_vec<L>(h.tangential_displacement, p), store_vec<L>(h.rolling_torque, p + 3 * kBlock);
}
template <class F>
[[gnu::always_inline]] inline ContactHistory<F> select_history(const auto& mask, const ContactHistory<F>& yes,
                                                               const ContactHistory<F>& no) {
  return {select_vec(mask, yes.tangential_displacement, no.tangential_displacement),
          select_vec(mask, yes.rolling_torque, no.rolling_torque)};
}
template <class F>
[[gnu::always_inline]] inline ContactHistory<F> no_history() {
  return {{F(0), F(0), F(0)}, {F(0), F(0), F(0)}};
}

// Adds force and torque to the rows named.
template <class L>
[[gnu::always_inline]] inline void add_to_rows(const ChunkTask<typename L::Real>& task, const uint16_t* row,
                                               const Vec<typename L::F>& force, const Vec<typename L::F>& torque) {
  using F = typename L::F;
  typename L::Real* rows[L::width];
  for (int k = 0; k < L::width; ++k) rows[k] = task.rows + 8 * size_t{row[k]};
  const F columns[8] = {force.x, force.y, force.z, torque.x, torque.y, torque.z, F(0), F(0)};
  L::add_rows(rows, columns);
}

}  // namespace scree
