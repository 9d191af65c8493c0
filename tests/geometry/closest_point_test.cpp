#include "geometry/closest_point.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/geometry/random_geometry.h"

namespace scree {
namespace {

// The least distance over a grid of the skeleton's parameters (s, t), then over ever smaller grids round the best so
// far: smaller so slowly that a best that lies aside is still caught. Round an axis t goes on past 0 and 1.
template <class Skeleton>
double sampled_distance(const Skeleton& skeleton, const Vec3& x) {
  const auto clamped = [](double a) { return std::clamp(a, 0.0, 1.0); };
  double best_s = 0.5, best_t = 0.5, least = 1e300;
  const auto search = [&](double half, int steps) {
    const double middle_s = best_s, middle_t = best_t;
    for (int i = -steps; i <= steps; ++i) {
      for (int j = -steps; j <= steps; ++j) {
        double t = middle_t + half * j / steps;
        if constexpr (!std::is_same_v<Skeleton, Revolution>) t = clamped(t);
        const double s = clamped(middle_s + half * i / steps), d = norm(x - point_of(skeleton, s, t));
        if (d < least) least = d, best_s = s, best_t = t;
      }
    }
  };
  search(0.5, 30);
  for (double half = 0.1; half > 1e-8; half *= 0.7) search(half, 5);
  return least;
}

template <class Make>
void expect_closest_point_matches_sampling(uint32_t seed, const Make& make) {
  RandomGeometry random(seed);
  for (int k = 0; k < 150; ++k) {
    const auto skeleton = make(random);
    const Vec3 x = random.in_cube(2);
    const Vec3 closest = closest_on(prepared(skeleton), x);
    EXPECT_NEAR(norm(x - closest), sampled_distance(skeleton, x), 1e-7) << "case " << k;
    EXPECT_NEAR(sampled_distance(skeleton, closest), 0, 1e-7) << "off the skeleton, case " << k;
  }
}

TEST(ClosestPoint, OnSegmentIsTheNearestOfManySamples) {
  expect_closest_point_matches_sampling(1, [](RandomGeometry& random) { return random.segment(); });
}

TEST(ClosestPoint, OnQuadIsTheNearestOfManySamples) {
  expect_closest_point_matches_sampling(2, [](RandomGeometry& random) { return random.quad(); });
}

TEST(ClosestPoint, OnTriangleIsTheNearestOfManySamples) {
  expect_closest_point_matches_sampling(3, [](RandomGeometry& random) { return random.triangle(); });
}

TEST(ClosestPoint, OnRevolutionIsTheNearestOfManySamples) {
  expect_closest_point_matches_sampling(4, [](RandomGeometry& random) { return random.revolution(); });
}

TEST(ClosestPoint, OnSegmentWithoutLengthIsItsPoint) {
  const Vec3 closest = closest_on(prepared(Segment{{1, 2, 3}, {1, 2, 3}}), Vec3{9, 9, 9});
  EXPECT_EQ(norm(closest - Vec3{1, 2, 3}), 0);
}

TEST(ClosestPoint, OnQuadDoesNotDependOnTheOrderOfItsCorners) {
  const Quad quad{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}}, reversed{{{0, 1, 0}, {1, 1, 0}, {1, 0, 0}, {0, 0, 0}}};
  const Vec3 above{0.25, 0.75, 0.5}, beside{2, 0.5, 0.5};
  EXPECT_EQ(norm(closest_on(prepared(quad), above) - Vec3{0.25, 0.75, 0}), 0);
  EXPECT_EQ(norm(closest_on(prepared(reversed), above) - Vec3{0.25, 0.75, 0}), 0);
  EXPECT_EQ(norm(closest_on(prepared(quad), beside) - Vec3{1, 0.5, 0}), 0);
  EXPECT_EQ(norm(closest_on(prepared(reversed), beside) - Vec3{1, 0.5, 0}), 0);
}

// Exactly on the axis, and on a slanted axis to round-off, where the radial part is noise.
TEST(ClosestPoint, OnCylinderFromItsAxisIsOneRadiusAwayAtTheSameHeight) {
  RandomGeometry random(5);
  for (int k = 0; k < 200; ++k) {
    const Vec3 axis = k == 0 ? Vec3{0, 0, 1} : random.direction();
    const Revolution cylinder{k == 0 ? Vec3{0, 0, 0} : random.in_cube(10), axis, 0.5, 0, 0.5, 1};
    const Vec3 x = cylinder.base + random.between(0, 1) * axis;
    const Vec3 to_wall = closest_on(prepared(cylinder), x) - x;
    EXPECT_NEAR(norm(to_wall), 0.5, 1e-13);
    EXPECT_NEAR(dot(to_wall, axis), 0, 1e-13);
  }
}

// What a lane type may do, and no more: no branch on a comparison, no implicit conversion from a literal.
struct Lane {
  double value;
  explicit Lane(double v) : value(v) {}
  Lane() : value(0) {}
};
struct LaneMask {
  bool value;
};
Lane operator+(Lane a, Lane b) { return Lane(a.value + b.value); }
Lane operator-(Lane a, Lane b) { return Lane(a.value - b.value); }
Lane operator-(Lane a) { return Lane(-a.value); }
Lane operator*(Lane a, Lane b) { return Lane(a.value * b.value); }
Lane operator/(Lane a, Lane b) { return Lane(a.value / b.value); }
LaneMask operator<(Lane a, Lane b) { return {a.value < b.value}; }
LaneMask operator>(Lane a, Lane b) { return {a.value > b.value}; }
LaneMask operator<=(Lane a, Lane b) { return {a.value <= b.value}; }
LaneMask operator>=(Lane a, Lane b) { return {a.value >= b.value}; }
LaneMask operator&(LaneMask a, LaneMask b) { return {a.value && b.value}; }
Lane min(Lane a, Lane b) { return Lane(scree::min(a.value, b.value)); }
Lane max(Lane a, Lane b) { return Lane(scree::max(a.value, b.value)); }
Lane sqrt(Lane a) { return Lane(scree::sqrt(a.value)); }
Lane fma(Lane a, Lane b, Lane c) { return Lane(scree::fma(a.value, b.value, c.value)); }
Lane select(LaneMask mask, Lane a, Lane b) { return mask.value ? a : b; }

Vec<Lane> lanes(const Vec3& v) { return {Lane(v.x), Lane(v.y), Lane(v.z)}; }
SegmentOf<Lane> lanes(const SegmentOf<double>& g) { return {lanes(g.a), lanes(g.edge), Lane(g.inverse_length2)}; }
QuadOf<Lane> lanes(const QuadOf<double>& g) {
  QuadOf<Lane> result{{}, lanes(g.normal), {}};
  for (int k = 0; k < 4; ++k) {
    result.corners[k] = lanes(g.corners[k]);
    result.inverse_length2[k] = Lane(g.inverse_length2[k]);
  }
  return result;
}
RevolutionOf<Lane> lanes(const RevolutionOf<double>& g) {
  return {lanes(g.base), lanes(g.axis), lanes(g.perpendicular), Lane(g.r0), Lane(g.h0),
          Lane(g.dr),    Lane(g.dh),    Lane(g.inverse_length2)};
}

template <class Skeleton>
void expect_lanes_give_the_same_bits(const Skeleton& skeleton, const Vec3& x) {
  const Vec3 scalar = closest_on(prepared(skeleton), x);
  const Vec<Lane> lane = closest_on(lanes(prepared(skeleton)), lanes(x));
  EXPECT_EQ(scalar.x, lane.x.value);
  EXPECT_EQ(scalar.y, lane.y.value);
  EXPECT_EQ(scalar.z, lane.z.value);
}

TEST(ClosestPoint, NeedsNoMoreOfANumberThanALaneOffersAndGivesTheSameBits) {
  RandomGeometry random(6);
  for (int k = 0; k < 200; ++k) {
    expect_lanes_give_the_same_bits(random.segment(), random.in_cube(2));
    expect_lanes_give_the_same_bits(random.quad(), random.in_cube(2));
    expect_lanes_give_the_same_bits(random.revolution(), random.in_cube(2));
  }
}

TEST(Distance, IsNegativeInsideARoundedPrimitive) {
  const Primitive fibre{Segment{{0, 0, 0}, {1, 0, 0}}, 0.25};
  EXPECT_DOUBLE_EQ(distance(fibre, {0.5, 0, 0}), -0.25);
  EXPECT_DOUBLE_EQ(distance(fibre, {0.5, 1, 0}), 0.75);
  EXPECT_DOUBLE_EQ(distance(fibre, {-1, 0, 0}), 0.75);
  EXPECT_EQ(norm(closest_on_skeleton(fibre, {0.5, 1, 0}) - Vec3{0.5, 0, 0}), 0);
}

TEST(Prepared, RefusesAQuadWithoutAreaAndAnAxisThatIsNotUnit) {
  EXPECT_THROW(prepared(Quad{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}}), std::invalid_argument);
  EXPECT_THROW(prepared(Revolution{{0, 0, 0}, {0, 0, 2}, 1, 0, 1, 1}), std::invalid_argument);
  EXPECT_THROW(prepared(Revolution{{0, 0, 0}, {0, 0, 1}, -1, 0, 1, 1}), std::invalid_argument);
}

}  // namespace
}  // namespace scree
