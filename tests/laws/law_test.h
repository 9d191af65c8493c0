// What the tests of laws share: every law is held in both storage precisions.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "kernels/parallel.h"
#include "tests/scenes.h"

namespace scree {

class LawTest : public testing::TestWithParam<Precision> {
 protected:
  void SetUp() override { set_thread_count(1); }  // a few particles: threads would only wait for each other

  // What arithmetic alone may cost a quantity that a law keeps exactly: `steps` roundings of its storage type.
  static double round_off(double steps = 1) { return steps * (GetParam() == Precision::reference ? 0x1p-53 : 0x1p-24); }
};

inline std::string precision_name(const testing::TestParamInfo<Precision>& info) {
  return info.param == Precision::reference ? "reference" : "mixed";
}

#define SCREE_IN_BOTH_PRECISIONS(suite) \
  INSTANTIATE_TEST_SUITE_P(In, suite, testing::Values(Precision::mixed, Precision::reference), precision_name)

// Stiff enough to be called rigid: 1e10 times steel.
inline const Material kRigid{"rigid", 0, 2e21, 0.3};

inline double degrees(double angle_deg) { return angle_deg * std::numbers::pi / 180; }

// Hertz: two elastic spheres (or a sphere and a wall) that meet head-on at `speed`. Johnson, Contact Mechanics (1985),
// section 11.4: largest overlap (15 m* v^2 / (16 E* sqrt(R*)))^(2/5), contact time 2.9433 times that over v.
struct HertzImpact {
  double effective_mass, effective_radius, effective_youngs, speed;

  double largest_overlap() const {
    return std::pow(15 * effective_mass * speed * speed / (16 * effective_youngs * std::sqrt(effective_radius)), 0.4);
  }
  double contact_time() const { return 2.94327 * largest_overlap() / speed; }
  double largest_force() const {
    return 4.0 / 3.0 * effective_youngs * std::sqrt(effective_radius) * std::pow(largest_overlap(), 1.5);
  }
};

}  // namespace scree
