// The contact laws: values in, values out. One source for the scalar double reference and the SIMD production loops.
//
// Symbols are those of Kaur et al. 2023 (doi 10.1115/1.4064018), Eqs. (1)-(19), as LIGGGHTS 3.8 applies them:
//   E*, G*  effective Young's and shear modulus     R*, m*  effective radius and mass     d  overlap
//   s = sqrt(R* d)   k_n = 4/3 E* s   k_t = 8 G* s   S_n = 2 E* s   S_t = 8 G* s
//   g_n = -2 sqrt(5/6) b sqrt(S_n m*)   g_t = -2 sqrt(5/6) b sqrt(S_t m*)   b = ln e / sqrt(ln^2 e + pi^2)
//
// Every output changes sign exactly when i and j are exchanged (n, v, w_r and the history change sign, the rest does
// not): a pair across two chunks is computed twice and both copies stay equal to the last bit.
#pragma once

#include "geometry/vec.h"

namespace scree {

enum class RollingModel { none, cdt, epsd2 };

// Touching bodies, seen from i. For a wall or fibre j has no spin, R* = R_i and m* = m_i.
template <class T>
struct Contact {
  Vec<T> normal;        // unit, from j to i
  T overlap;            // m, >= 0
  T effective_radius;   // m
  T effective_mass;     // kg
  Vec<T> velocity;      // m/s, of i relative to j, centres (wall: its surface)
  Vec<T> arm_spin;      // m/s, c_i w_i + c_j w_j, c the lever arms
  Vec<T> rolling_spin;  // rad/s, w_i - w_j; wall: w_i c_i / (R_i - d)
};

// What a pair of materials gives to the law; see pair_constants() for how it is made from moduli.
template <class T>
struct PairConstants {
  T effective_youngs;    // E*, Pa
  T effective_shear;     // G*, Pa
  T normal_damping;      // -2 sqrt(5/6) b sqrt(2 E*), so that g_n = this * sqrt(s m*)
  T tangential_damping;  // -2 sqrt(5/6) b sqrt(8 G*)
  T sliding_friction;
  T rolling_friction;
};

// What a contact remembers. Zero when it begins; lost when it opens.
template <class T>
struct ContactHistory {
  Vec<T> tangential_displacement;  // m
  Vec<T> rolling_torque;           // N m, EPSD2 only
};

template <class T>
struct Reaction {
  Vec<T> force;         // N, on i; -force on j
  Vec<T> lever_torque;  // N, n x F_t; torque on i: -c_i times this, on j: -c_j times this
  Vec<T> rolling;       // N m, M; -M on i, +M on j
  T elastic;            // N, the spring's part of the normal force
};

// The normal force, and what the other parts take from it.
template <class T>
struct NormalResponse {
  T force, elastic;      // N: spring and dashpot; the spring's part
  T friction_limit;      // N, Coulomb's
  T tangential_spring;   // k_t, N/m
  T tangential_damping;  // g_t, N s/m
};

// `limit_attraction`: F_n >= 0 (LIGGGHTS's option limitForce; off there and here).
template <class T>
[[gnu::always_inline]] inline NormalResponse<T> hertz_normal(const Contact<T>& c, const PairConstants<T>& p,
                                                             bool limit_attraction) {
  const T s = sqrt(c.effective_radius * c.overlap);
  const T root_sm = sqrt(s * c.effective_mass);
  const T k_n = T(4.0 / 3.0) * p.effective_youngs * s;
  const T elastic = k_n * c.overlap;
  T force = nfma(p.normal_damping * root_sm, dot(c.velocity, c.normal), elastic);
  if (limit_attraction) force = max(force, T(0));
  return {force, elastic, p.sliding_friction * abs(force), T(8.0f) * p.effective_shear * s,
          p.tangential_damping * root_sm};
}

// The tangential part: Mindlin's spring with history, cut by Coulomb's limit.
template <class T>
[[gnu::always_inline]] inline Vec<T> mindlin_friction(const Contact<T>& c, const NormalResponse<T>& n, const T& dt,
                                                      Vec<T>& xi) {
  const Vec<T> v_t = nfma(dot(c.velocity, c.normal), c.normal, c.velocity);
  const Vec<T> v_s = v_t + cross(c.normal, c.arm_spin);
  xi = fma(dt, v_s, xi);
  xi = nfma(dot(xi, c.normal), c.normal, xi);
  const T spring = n.tangential_spring * sqrt(dot(xi, xi));
  const auto slides = spring > n.friction_limit;
  const T scale = n.friction_limit / spring;  // used where it slides only, and there spring > 0
  xi = select_vec(slides, scale * xi, xi);
  const T damping = select(slides, T(0), n.tangential_damping);
  return nfms(damping, v_s, n.tangential_spring * xi);
}

// Rolling friction torque M (physics: constant directional torque, and elastic-plastic spring without dashpot).
template <RollingModel model, class T>
[[gnu::always_inline]] inline Vec<T> rolling_friction(const Contact<T>& c, const PairConstants<T>& p,
                                                      const NormalResponse<T>& n, const T& dt, Vec<T>& torque_old) {
  if constexpr (model == RollingModel::cdt) {
    const T spin = sqrt(dot(c.rolling_spin, c.rolling_spin));
    const T size = select(spin > T(0), p.rolling_friction * n.elastic * c.effective_radius / spin, T(0));
    const Vec<T> m = size * c.rolling_spin;
    return nfma(dot(m, c.normal), c.normal, m);
  } else if constexpr (model == RollingModel::epsd2) {
    const T k_r = n.tangential_spring * c.effective_radius * c.effective_radius;
    const Vec<T> w_t = nfma(dot(c.rolling_spin, c.normal), c.normal, c.rolling_spin);
    Vec<T> m = fma(k_r * dt, w_t, torque_old);
    const T limit = p.rolling_friction * abs(n.force) * c.effective_radius;
    const T size = sqrt(dot(m, m));
    const T scale = limit / size;
    m = select_vec(size > limit, scale * m, m);
    torque_old = m;
    return m;
  } else {
    return {T(0), T(0), T(0)};
  }
}

// Hertz-Mindlin with history: the three parts together.
template <RollingModel model, class T>
[[gnu::always_inline]] inline Reaction<T> hertz_mindlin(const Contact<T>& c, const PairConstants<T>& p, const T& dt,
                                                        bool limit_attraction, ContactHistory<T>& history) {
  const NormalResponse<T> n = hertz_normal(c, p, limit_attraction);
  const Vec<T> tangential = mindlin_friction(c, n, dt, history.tangential_displacement);
  const Vec<T> rolling = rolling_friction<model>(c, p, n, dt, history.rolling_torque);
  return {fma(n.force, c.normal, tangential), cross(c.normal, tangential), rolling, n.elastic};
}

}  // namespace scree
