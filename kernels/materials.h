// Materials turned into the numbers that the contact law uses.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "kernels/contact_law.h"

namespace scree {

struct ElasticModuli {
  double youngs_modulus;  // Pa
  double poisson_ratio;
};

// b = ln e / sqrt(ln^2 e + pi^2): -1 for e = 0 (its limit), 0 for e = 1.
inline double damping_ratio(double restitution) {
  if (restitution <= 0) return -1;
  const double l = std::log(restitution);
  return l / std::sqrt(l * l + std::numbers::pi * std::numbers::pi);
}

// 1/E* = (1-nu_i^2)/E_i + (1-nu_j^2)/E_j,  1/G* = 2(2-nu_i)(1+nu_i)/E_i + 2(2-nu_j)(1+nu_j)/E_j.
inline PairConstants<double> pair_constants(const ElasticModuli& i, const ElasticModuli& j, double restitution,
                                            double sliding_friction, double rolling_friction) {
  const auto compliance = [](const ElasticModuli& m) {
    return (1 - m.poisson_ratio * m.poisson_ratio) / m.youngs_modulus;
  };
  const auto shear = [](const ElasticModuli& m) {
    return 2 * (2 - m.poisson_ratio) * (1 + m.poisson_ratio) / m.youngs_modulus;
  };
  const double youngs_star = 1 / (compliance(i) + compliance(j));
  const double shear_star = 1 / (shear(i) + shear(j));
  const double c = -2 * std::sqrt(5.0 / 6.0) * damping_ratio(restitution);
  return {youngs_star,      shear_star,      c * std::sqrt(2 * youngs_star), c * std::sqrt(8 * shear_star),
          sliding_friction, rolling_friction};
}

// Constants for every pair (particle kind, particle kind or wall material): row kind_i, column kind_j for particles,
// kinds + material for walls and fibres. Eight Reals a row, the last two unused, so that lanes load rows.
template <class Real>
struct MaterialTable {
  struct alignas(32) Row {
    Real value[8] = {};
  };
  uint32_t kinds = 0, columns = 0;
  bool uniform_pairs = false;  // all particle pairs share one row
  bool uniform_walls = false;  // all wall contacts share one row
  std::vector<Row> rows;       // kinds x columns

  void set(uint32_t kind, uint32_t column, const PairConstants<double>& p) {
    const double values[6] = {p.effective_youngs,   p.effective_shear,  p.normal_damping,
                              p.tangential_damping, p.sliding_friction, p.rolling_friction};
    for (int k = 0; k < 6; ++k) rows[kind * columns + column].value[k] = static_cast<Real>(values[k]);
  }
  const Real* row(uint32_t kind, uint32_t column) const { return rows[kind * columns + column].value; }
};

}  // namespace scree
