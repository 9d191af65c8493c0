#include "geometry/bounds.h"

#include <gtest/gtest.h>

#include "tests/geometry/random_geometry.h"

namespace scree {
namespace {

// Samples the surface by support points: the skeleton's sample moved by the radius along each coordinate.
template <class Skeleton>
Bounds sampled_bounds(const Skeleton& skeleton, double radius) {
  Bounds result = empty_bounds();
  constexpr int kSteps = 200;
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; j <= kSteps; ++j) {
      const Vec3 p = point_of(skeleton, double(i) / kSteps, double(j) / kSteps);
      result = united(result, {p, p});
    }
  }
  const Vec3 r{radius, radius, radius};
  return {result.min - r, result.max + r};
}

void expect_holds_tightly(const Bounds& bounds, const Bounds& samples, double slack) {
  EXPECT_TRUE(contains(inflated(bounds, 1e-12), samples.min));
  EXPECT_TRUE(contains(inflated(bounds, 1e-12), samples.max));
  EXPECT_TRUE(contains(inflated(samples, slack), bounds.min)) << "looser than the samples";
  EXPECT_TRUE(contains(inflated(samples, slack), bounds.max)) << "looser than the samples";
}

TEST(Bounds, HoldSampledSurfacePointsAndLittleMore) {
  RandomGeometry random(11);
  for (int k = 0; k < 30; ++k) {
    const double radius = random.between(0, 0.5);
    const Segment segment = random.segment();
    expect_holds_tightly(bounds_of(Primitive{segment, radius}), sampled_bounds(segment, radius), 1e-12);
    const Quad quad = random.quad();
    expect_holds_tightly(bounds_of(Primitive{quad, radius}), sampled_bounds(quad, radius), 1e-12);
    const Revolution revolution = random.revolution();
    expect_holds_tightly(bounds_of(Primitive{revolution, radius}), sampled_bounds(revolution, radius), 2e-4);
  }
}

TEST(Bounds, OfASolidHoldEveryPrimitive) {
  const Solid solid{{}, {Primitive{Segment{{0, 0, 0}, {1, 0, 0}}, 0.5}, Primitive{Segment{{0, 7, 0}, {0, 7, -3}}, 1}}};
  const Bounds bounds = bounds_of(solid);
  EXPECT_EQ(norm(bounds.min - Vec3{-1, -0.5, -4}), 0);
  EXPECT_EQ(norm(bounds.max - Vec3{1.5, 8, 1}), 0);
}

TEST(Bounds, OfAnEmptySolidHoldNothing) {
  EXPECT_FALSE(contains(bounds_of(Solid{}), {0, 0, 0}));
  EXPECT_EQ(volume_of(bounds_of(Solid{})), 0);
}

TEST(Bounds, ContainTheirFacesAndNothingBeyond) {
  const Bounds box{{0, 0, 0}, {1, 2, 3}};
  EXPECT_TRUE(contains(box, {1, 2, 3}));
  EXPECT_TRUE(contains(box, {0, 0, 0}));
  EXPECT_FALSE(contains(box, {1, 2, 3.0001}));
  EXPECT_TRUE(contains(inflated(box, 0.001), {1, 2, 3.0001}));
  EXPECT_EQ(volume_of(box), 6);
}

}  // namespace
}  // namespace scree
