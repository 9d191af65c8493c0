// What the engine rests on in the law: exchange of i and j, the constants, the kinematics of a pair.
#include "kernels/contact_law.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "kernels/materials.h"
#include "kernels/pair_pass.h"
#include "kernels/periodic.h"

namespace scree {
namespace {

class Random {
 public:
  explicit Random(uint32_t seed) : engine_(seed) {}
  double between(double low, double high) { return low + (high - low) * (engine_() / 4294967296.0); }
  template <class T>
  Vec<T> vector(double size) {
    const double x = between(-size, size), y = between(-size, size), z = between(-size, size);
    return {static_cast<T>(x), static_cast<T>(y), static_cast<T>(z)};
  }

 private:
  std::mt19937 engine_;
};

constexpr ElasticModuli kSoft{1e7, 0.28}, kHard{7e10, 0.33};

template <class Real>
PairConstants<Real> narrowed(const PairConstants<double>& p) {
  return {static_cast<Real>(p.effective_youngs), static_cast<Real>(p.effective_shear),
          static_cast<Real>(p.normal_damping),   static_cast<Real>(p.tangential_damping),
          static_cast<Real>(p.sliding_friction), static_cast<Real>(p.rolling_friction)};
}

template <class T>
void expect_negated(const Vec<T>& a, const Vec<T>& b, const char* what) {
  EXPECT_EQ(a.x, -b.x) << what;
  EXPECT_EQ(a.y, -b.y) << what;
  EXPECT_EQ(a.z, -b.z) << what;
}

// A pair across two chunks is computed twice, once from each side; the two must stay mirror images for ever. From
// positions on, with history, through many steps of one history.
template <class Real, RollingModel rolling>
void expect_exactly_odd(uint32_t seed) {
  using L = ScalarLanes<Real>;
  Random random(seed);
  const PairConstants<Real> constants = narrowed<Real>(pair_constants(kSoft, kSoft, 0.52, 0.53, 0.37));
  StepSettings settings{};
  settings.period[0] = 0.01, settings.inverse_period[0] = 100;
  int slid = 0, stuck = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const auto body = [&](const Vec<double>& x) {
      return Bodies<L>{x, random.vector<Real>(0.3), random.vector<Real>(500),
                       static_cast<Real>(random.between(1e-4, 1e-3)),
                       static_cast<Real>(std::pow(10, random.between(6, 9)))};
    };
    Bodies<L> i = body(random.vector<double>(0.01)), j = body({0, 0, 0});
    const Vec3 n = unit(random.vector<double>(1));
    j.position = i.position - ((double(i.radius) + double(j.radius)) * random.between(0.9, 0.99999)) * n;
    if (trial % 2) j.position.x += 0.01;  // across the periodic border
    ContactHistory<Real> seen_from_i{random.vector<Real>(2e-7), random.vector<Real>(1e-9)};
    ContactHistory<Real> seen_from_j{-seen_from_i.tangential_displacement, -seen_from_i.rolling_torque};
    for (int step = 0; step < 4; ++step) {
      PairGeometry<L> g, h;
      pair_geometry<L, true>(i, j, settings, g);
      pair_geometry<L, true>(j, i, settings, h);
      ASSERT_GT(g.contact.overlap, 0);
      ASSERT_EQ(g.contact.overlap, h.contact.overlap);
      ASSERT_EQ(g.arm_i, h.arm_j);
      ASSERT_EQ(g.arm_j, h.arm_i);
      const Real dt = static_cast<Real>(5e-6);
      const bool limit_attraction = trial % 3 == 0;
      const auto a = hertz_mindlin<rolling>(g.contact, constants, dt, limit_attraction, seen_from_i);
      const auto b = hertz_mindlin<rolling>(h.contact, constants, dt, limit_attraction, seen_from_j);
      expect_negated(a.force, b.force, "force");
      expect_negated(a.rolling, b.rolling, "rolling torque");
      expect_negated(seen_from_i.tangential_displacement, seen_from_j.tangential_displacement, "tangential history");
      expect_negated(seen_from_i.rolling_torque, seen_from_j.rolling_torque, "rolling history");
      EXPECT_EQ(a.lever_torque.x, b.lever_torque.x);  // n and F_t both change sign
      EXPECT_EQ(a.lever_torque.y, b.lever_torque.y);
      EXPECT_EQ(a.lever_torque.z, b.lever_torque.z);
      const Vec3 f{a.force.x, a.force.y, a.force.z}, normal{g.contact.normal.x, g.contact.normal.y, g.contact.normal.z};
      const double along = dot(f, normal), across = norm(f - along * normal);
      (across > 0.999 * 0.53 * std::abs(along) ? slid : stuck) += 1;
      if (::testing::Test::HasFailure()) return;
    }
  }
  EXPECT_GT(slid, 100);
  EXPECT_GT(stuck, 100);
}

TEST(ContactLaw, IsExactlyOddInExchangeOfTheTwo) {
  expect_exactly_odd<float, RollingModel::none>(1);
  expect_exactly_odd<float, RollingModel::cdt>(2);
  expect_exactly_odd<float, RollingModel::epsd2>(3);
  expect_exactly_odd<double, RollingModel::epsd2>(4);
}

TEST(ContactLaw, OfACentralCollisionIsHertz) {
  // Two equal spheres, 1 % overlap, approaching at 0.1 m/s; by hand from physics.md.
  Contact<double> c{{0, 0, 1}, 4e-6, 1e-4, 5e-8, {0, 0, -0.1}, {0, 0, 0}, {0, 0, 0}};
  const double youngs = 1e7 / (2 * (1 - 0.28 * 0.28)), l = std::log(0.52), b = l / std::sqrt(l * l + M_PI * M_PI);
  const double elastic = 4.0 / 3.0 * youngs * std::sqrt(1e-4) * std::pow(4e-6, 1.5);
  const double damping = -2 * std::sqrt(5.0 / 6.0) * b * std::sqrt(2 * youngs * std::sqrt(1e-4 * 4e-6) * 5e-8);
  ContactHistory<double> history{};
  const auto r =
      hertz_mindlin<RollingModel::epsd2>(c, pair_constants(kSoft, kSoft, 0.52, 0.5, 0.3), 5e-6, false, history);
  EXPECT_NEAR(r.force.z, elastic + 0.1 * damping, 1e-12 * r.force.z);
  EXPECT_EQ(r.force.x, 0);
  EXPECT_EQ(r.force.y, 0);
}

TEST(ContactLaw, KeepsTheSpringWithinCoulombsLimit) {
  Random random(8);
  const PairConstants<double> p = pair_constants(kSoft, kSoft, 0.52, 0.4, 0.3);
  for (int trial = 0; trial < 1000; ++trial) {
    const Vec3 n = unit(random.vector<double>(1));
    Contact<double> c{n,
                      random.between(1e-8, 1e-6),
                      1e-4,
                      5e-8,
                      random.vector<double>(0.1),
                      random.vector<double>(0.1),
                      random.vector<double>(100)};
    ContactHistory<double> h{random.vector<double>(1e-6), random.vector<double>(1e-6)};
    const auto r = hertz_mindlin<RollingModel::epsd2>(c, p, 5e-6, false, h);
    const double normal_force = std::abs(dot(r.force, n)),
                 k_t = 8 * p.effective_shear * std::sqrt(c.effective_radius * c.overlap);
    EXPECT_LE(k_t * norm(h.tangential_displacement), 0.4 * normal_force * (1 + 1e-9));
    EXPECT_LE(norm(r.rolling), 0.3 * normal_force * c.effective_radius * (1 + 1e-9));
    EXPECT_NEAR(dot(h.tangential_displacement, n), 0, 1e-12 * norm(h.tangential_displacement) + 1e-20);
    EXPECT_EQ(norm(r.rolling - h.rolling_torque), 0);
  }
}

// ---- constants
// ---------------------------------------------------------------------------------------------------------

TEST(PairConstants, AreThoseWorkedOutByHand) {
  // E 10 MPa, nu 0.25 against E 40 MPa, nu 0.4:
  //   (1 - 1/16)/1e7 = 9.375e-8, (1 - 0.16)/4e7 = 2.1e-8           E* = 1/1.1475e-7 = 8714596.949891067 Pa
  //   2 1.75 1.25/1e7 = 4.375e-7, 2 1.6 1.4/4e7 = 1.12e-7          G* = 1/5.495e-7 = 1819836.214740673 Pa
  //   e = 0.5: ln e = -0.6931471805599453, b = -0.2154558847...    -2 sqrt(5/6) b = 0.393372...
  const auto p = pair_constants({1e7, 0.25}, {4e7, 0.4}, 0.5, 0.3, 0.2);
  EXPECT_NEAR(p.effective_youngs, 8714596.949891067, 1e-6);
  EXPECT_NEAR(p.effective_shear, 1819836.214740673, 1e-6);
  const double b = -0.6931471805599453 / std::sqrt(0.4804530139182014 + 9.869604401089358),
               c = -2 * 0.9128709291752769 * b;
  EXPECT_NEAR(b, -0.21545, 1e-5);
  EXPECT_NEAR(p.normal_damping, c * std::sqrt(17429193.899782134), 1e-9 * p.normal_damping);
  EXPECT_NEAR(p.tangential_damping, c * std::sqrt(14558689.717925384), 1e-9 * p.tangential_damping);
  EXPECT_EQ(p.sliding_friction, 0.3);
  EXPECT_EQ(p.rolling_friction, 0.2);
}

TEST(PairConstants, DoNotDependOnTheOrderOfTheTwo) {
  const auto a = pair_constants(kSoft, kHard, 0.5, 0.3, 0.2), b = pair_constants(kHard, kSoft, 0.5, 0.3, 0.2);
  EXPECT_EQ(a.effective_youngs, b.effective_youngs);
  EXPECT_EQ(a.effective_shear, b.effective_shear);
  EXPECT_EQ(a.normal_damping, b.normal_damping);
}

TEST(PairConstants, OfDampingReachTheirLimits) {
  EXPECT_EQ(damping_ratio(0), -1);
  EXPECT_EQ(damping_ratio(1), 0);
  EXPECT_NEAR(damping_ratio(1e-300), -1, 1e-4);
  EXPECT_LT(damping_ratio(0.999999), 0);
  double before = -1;
  for (double e = 0.01; e <= 1; e += 0.01) {
    EXPECT_GT(damping_ratio(e), before);
    before = damping_ratio(e);
  }
  EXPECT_EQ(pair_constants(kSoft, kSoft, 1, 0, 0).normal_damping, 0);
  EXPECT_GT(pair_constants(kSoft, kSoft, 0, 0, 0).tangential_damping, 0);
}

TEST(MaterialTable, GivesBackTheRowsThatWereSet) {
  MaterialTable<float> t;
  t.kinds = 2, t.columns = 5;
  t.rows.resize(10);
  t.set(1, 3, {1, 2, 3, 4, 5, 6});
  for (int k = 0; k < 6; ++k) EXPECT_EQ(t.row(1, 3)[k], static_cast<float>(k + 1));
  EXPECT_EQ(t.row(1, 2)[0], 0);
  EXPECT_EQ(t.row(1, 4)[0], 0);
  EXPECT_EQ(reinterpret_cast<uintptr_t>(t.row(1, 3)) % 32, 0u);
}

// ---- periodic axes
// -----------------------------------------------------------------------------------------------------

Vec3 nearest_image(const Vec3& d, const double (&period)[3]) {
  double inverse[3];
  for (int a = 0; a < 3; ++a) inverse[a] = period[a] > 0 ? 1 / period[a] : 0;
  return minimum_image(d, period, inverse);
}

TEST(MinimumImage, IsExactlyOddAndTheShortest) {
  Random random(6);
  for (int trial = 0; trial < 20000; ++trial) {
    const double period[3] = {random.between(0.001, 3), trial % 2 ? random.between(0.001, 3) : 0,
                              random.between(0.001, 3)};
    const Vec3 d{random.between(-1, 1) * period[0], random.between(-9, 9), random.between(-3, 3) * period[2]};
    const Vec3 near = nearest_image(d, period);
    expect_negated(nearest_image(-d, period), near, "minimum image");
    EXPECT_LE(std::abs(near.x), 0.5 * period[0] * (1 + 1e-12));
    EXPECT_LE(std::abs(near.z), 0.5 * period[2] * (1 + 1e-12));
    if (period[1] == 0) {
      EXPECT_EQ(near.y, d.y);
    }
    EXPECT_NEAR(std::remainder(near.x - d.x, period[0]), 0, 1e-12);
  }
}

TEST(MinimumImage, OfHalfAPeriodIsOdd) {
  const double period[3] = {1, 2, 0.3};
  for (const Vec3& d : {Vec3{0.5, 1, 0.15}, Vec3{1.5, 3, 0.45}, Vec3{2.5, 5, 0.75}})
    expect_negated(nearest_image(-d, period), nearest_image(d, period), "half a period");
}

TEST(MinimumImage, LeavesShortDistancesAloneToTheLastBit) {
  Random random(7);
  const double period[3] = {0.01, 0.02, 0.03};
  for (int trial = 0; trial < 1000; ++trial) {
    const Vec3 d = random.vector<double>(0.0049), near = nearest_image(d, period);
    EXPECT_EQ(norm(near - d), 0);
  }
}

}  // namespace
}  // namespace scree
