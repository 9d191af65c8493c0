// What contacts do to energy and momentum, for the ledger of a run. Kernels without a ledger carry none of it.
//
// Powers are taken with the velocities that the law sees, half a step behind; what that leaves of a step's exact change
// of kinetic energy, F (F + m g) dt^2 / 2 m, is a term of its own (second_order), so that the parts add up to
// round-off.
#pragma once

#include "kernels/lane_bodies.h"
#include "kernels/step_outcome.h"

namespace scree {

// A block's powers, W, and forces of the solid, N, contact by contact: summed in the contacts' order, so that the sums
// do not depend on the lanes' width.
template <class Real>
struct BlockWork {
  enum Row { elastic, damping, friction, rolling, walls, force_x, force_y, force_z, rows };
  alignas(64) Real value[rows][kBlock] = {};

  void add_to(StepLedger& sums) const {
    double* const to[rows] = {&sums.elastic, &sums.damping,          &sums.friction,         &sums.rolling,
                              &sums.walls,   &sums.solid_impulse[0], &sums.solid_impulse[1], &sums.solid_impulse[2]};
    for (int row = 0; row < rows; ++row)
      for (int k = 0; k < kBlock; ++k) *to[row] += static_cast<double>(value[row][k]);
  }
};
struct NoWork {};

template <class L>
inline void add_row(typename L::Real* to, const typename L::F& value) {
  L::store(L::load(to) + value, to);
}

// Adds a contact's powers, `share` of them (1, or half where another chunk counts the pair too), where it touches.
template <class L, class Mask>
inline void add_powers(const Contact<typename L::F>& c, const Reaction<typename L::F>& r, const typename L::F& share,
                       const Mask& touching, BlockWork<typename L::Real>& work, int lane) {
  using F = typename L::F;
  using Row = BlockWork<typename L::Real>;
  const F weight = select(touching, share, F(0)), zero(0);
  const F v_n = dot(c.velocity, c.normal), f_n = dot(r.force, c.normal);
  const Vec<F> v_s = c.velocity - v_n * c.normal + cross(c.normal, c.arm_spin);
  const Vec<F> f_t = r.force - f_n * c.normal;
  const auto note = [&](typename Row::Row row, const F& power) {
    add_row<L>(work.value[row] + lane, select(touching, weight * power, zero));
  };
  note(Row::elastic, -(r.elastic * v_n));
  note(Row::damping, -((f_n - r.elastic) * v_n));
  note(Row::friction, -dot(f_t, v_s));
  note(Row::rolling, dot(r.rolling, c.rolling_spin));
}

}  // namespace scree
