#include "geometry/walls.h"

#include <gtest/gtest.h>

#include <functional>

#include "geometry/bounds.h"
#include "tests/geometry/random_geometry.h"

namespace scree {
namespace {

double distance_to_all(const Primitives& walls, const Vec3& x) {
  double least = INFINITY;
  for (const Primitive& wall : walls) least = std::min(least, distance(wall, x));
  return least;
}

constexpr Frustum kPaperHopper{.z0 = 0.1, .bottom_x = 0.05, .bottom_y = 0.01, .z1 = 0.22, .top_x = 0.08, .top_y = 0.04};

TEST(Walls, FrustumClosesAllSidesBetweenItsRectangles) {
  const Primitives hopper = frustum(kPaperHopper, {2, 5});
  ASSERT_EQ(hopper.size(), 4u);
  RandomGeometry random(31);
  for (int k = 0; k < 500; ++k) {
    const double t = random.between(0, 1), z = 0.1 + t * 0.12, half_x = 0.025 + t * 0.015, half_y = 0.005 + t * 0.015;
    const double s = random.between(-1, 1);
    EXPECT_NEAR(distance_to_all(hopper, {half_x, s * half_y, z}), 0, 1e-15);
    EXPECT_NEAR(distance_to_all(hopper, {-half_x, s * half_y, z}), 0, 1e-15);
    EXPECT_NEAR(distance_to_all(hopper, {s * half_x, half_y, z}), 0, 1e-15);
    EXPECT_NEAR(distance_to_all(hopper, {s * half_x, -half_y, z}), 0, 1e-15);
  }
  EXPECT_NEAR(distance_to_all(hopper, {0, 0, 0.1}), 0.005, 1e-4);  // open below
  EXPECT_EQ(hopper[3].material, 2u);
  EXPECT_EQ(hopper[3].wall, 5u);
}

TEST(Walls, FrustumStandsOnItsCentre) {
  Frustum shape = kPaperHopper;
  shape.centre_x = 1, shape.centre_y = -2;
  const Bounds bounds = bounds_of(Solid{{}, frustum(shape, {})});
  EXPECT_NEAR(norm(bounds.min - Vec3{0.96, -2.02, 0.1}), 0, 1e-15);
  EXPECT_NEAR(norm(bounds.max - Vec3{1.04, -1.98, 0.22}), 0, 1e-15);
}

TEST(Walls, BoxHasTheFacesAskedFor) {
  const Bounds box{{0, 0, 0}, {1, 2, 3}};
  EXPECT_EQ(box_walls(box, {}, {}).size(), 6u);
  EXPECT_NEAR(distance_to_all(box_walls(box, {}, {}), {0.9, 1, 1.5}), 0.1, 1e-15);
  const Primitives open_above = box_walls(box, {.z_max = false}, {});
  EXPECT_EQ(open_above.size(), 5u);
  EXPECT_NEAR(distance_to_all(open_above, {0.5, 1, 2.99}), 0.5, 1e-15);
}

TEST(Walls, ChannelIsOpenAboveAndBelow) {
  const Primitives walls = channel({{-0.025, -0.005, 0}, {0.025, 0.005, 0.1}}, {});
  ASSERT_EQ(walls.size(), 4u);
  EXPECT_NEAR(distance_to_all(walls, {0, 0, 0}), 0.005, 1e-15);
  EXPECT_NEAR(distance_to_all(walls, {0.024, 0, 0.1}), 0.001, 1e-15);
  EXPECT_NEAR(distance_to_all(walls, {0, -0.004, 0.05}), 0.001, 1e-15);
}

TEST(Walls, PlaneCoversEveryPointOfItInTheDomain) {
  RandomGeometry random(32);
  const Bounds domain{{-1, -2, -3}, {2, 1, 4}};
  for (int k = 0; k < 300; ++k) {
    const Vec3 point = random.in_box(domain), normal = random.direction();
    const Primitives wall = plane(point, 2.5 * normal, domain, {});
    ASSERT_EQ(wall.size(), 1u);
    for (int j = 0; j < 20; ++j) {
      const Vec3 x = random.in_box(domain), foot = x - dot(x - point, normal) * normal;
      if (!contains(domain, foot)) continue;
      EXPECT_NEAR(distance(wall[0], x), std::abs(dot(x - point, normal)), 1e-12);
    }
  }
}

TEST(Walls, PlaneAcrossACoordinateAxisIsTheDomainsSection) {
  const Bounds domain{{-1, -2, -3}, {2, 1, 4}};
  for (const double z : {0.5, -3.0, 4.0}) {  // inside, and on a face
    const Bounds bounds = bounds_of(plane({7, 7, z}, {0, 0, -1}, domain, {})[0]);
    EXPECT_NEAR(norm(bounds.min - Vec3{-1, -2, z}), 0, 1e-14);
    EXPECT_NEAR(norm(bounds.max - Vec3{2, 1, z}), 0, 1e-14);
  }
}

TEST(Walls, RoundOnesAreWhereTheirRadiiSay) {
  const Vec3 base{1, 2, 3}, up{0, 0, 2};  // the axis need not be unit
  EXPECT_NEAR(distance(cylinder(base, up, 0.5, 2, {})[0], {1, 2.3, 4}), 0.2, 1e-15);
  EXPECT_NEAR(distance(cylinder(base, up, 0.5, 2, {})[0], {1, 2.5, 6}), 1, 1e-15);
  EXPECT_NEAR(distance(disc(base, up, 0.5, {})[0], {1.2, 2, 2}), 1, 1e-15);
  EXPECT_NEAR(distance(disc(base, up, 0.5, {})[0], {2.5, 2, 3}), 1, 1e-15);
  EXPECT_NEAR(distance(annulus(base, up, 0.5, 1, {})[0], {1.1, 2, 3}), 0.4, 1e-15);
  EXPECT_NEAR(distance(annulus(base, up, 0.5, 1, {})[0], {1, 2.7, 3.1}), 0.1, 1e-15);
  const Primitives funnel = cone({.base = base, .axis = up, .base_radius = 0, .top_radius = 1, .height = 1}, {});
  EXPECT_NEAR(distance(funnel[0], {1, 2, 4}), std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(distance(funnel[0], {1.25, 2, 3.25}), 0, 1e-15);
}

TEST(Walls, FibreNetworkMakesOneCapsuleForEachLine) {
  const std::vector<Segment> axes{{{0, 0, 0}, {1, 0, 0}}, {{0, 0, 0}, {0, 1, 0}}};
  const Primitives fibres = fibre_network(axes, 0.2, {1, 2});
  ASSERT_EQ(fibres.size(), 2u);
  EXPECT_NEAR(distance(fibres[1], {0.3, 0.5, 0}), 0.2, 1e-15);
  EXPECT_EQ(fibres[1].material, 1u);
  EXPECT_EQ(fibres[1].wall, 2u);
}

// Each row: a call with one bad argument, and what its message must contain: the name and the value.
struct Refused {
  std::string expected;
  std::function<void()> call;
};

Frustum hopper_with(double bottom_x, double z1) {
  Frustum shape = kPaperHopper;
  shape.bottom_x = bottom_x, shape.z1 = z1;
  return shape;
}

const std::vector<Refused> kRefused = {
    {"bottom_x = -0.05 m", [] { frustum(hopper_with(-0.05, 0.22), {}); }},
    {"z1 = 0.09 m", [] { frustum(hopper_with(0.05, 0.09), {}); }},
    {"radius = 0 m",
     [] {
       cylinder({0, 0, 0}, {0, 0, 1}, 0, 1, {});
     }},
    {"height = -2 m",
     [] {
       cylinder({0, 0, 0}, {0, 0, 1}, 1, -2, {});
     }},
    {"length of axis = 0",
     [] {
       disc({0, 0, 0}, {0, 0, 0}, 1, {});
     }},
    {"base.y = nan m",
     [] {
       disc({0, NAN, 0}, {0, 0, 1}, 1, {});
     }},
    {"radius = inf m",
     [] {
       disc({0, 0, 0}, {0, 0, 1}, INFINITY, {});
     }},
    {"outer_radius = 0.5 m",
     [] {
       annulus({0, 0, 0}, {0, 0, 1}, 0.75, 0.5, {});
     }},
    {"inner_radius = -1 m",
     [] {
       annulus({0, 0, 0}, {0, 0, 1}, -1, 0.5, {});
     }},
    {"top_radius = -1 m", [] { cone({.base_radius = 1, .top_radius = -1, .height = 1}, {}); }},
    {"top_radius = 0 m", [] { cone({.height = 1}, {}); }},
    {"height = 0 m", [] { cone({.base_radius = 1, .height = 0}, {}); }},
    {"box.max.y = -1 m",
     [] {
       box_walls({{0, 0, 0}, {1, -1, 1}}, {}, {});
     }},
    {"box.max.z = 0 m",
     [] {
       channel({{0, 0, 0}, {1, 1, 0}}, {});
     }},
    {"other_edge = 0.707107",
     [] {
       rectangle({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {});
     }},
    {"length of normal = 0",
     [] {
       plane({0, 0, 0}, {0, 0, 0}, {{0, 0, 0}, {1, 1, 1}}, {});
     }},
    {"centre = 4.5 m",
     [] {
       plane({0, 0, 5}, {0, 0, 1}, {{0, 0, 0}, {1, 1, 1}}, {});
     }},
    {"domain.max.x = -1 m",
     [] {
       plane({0, 0, 0}, {0, 0, 1}, {{0, 0, 0}, {-1, 1, 1}}, {});
     }},
    {"area of quad = 0 m2",
     [] {
       quad({Vec3{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}, {});
     }},
    {"warp of quad = 0.",
     [] {
       quad({Vec3{0, 0, 0}, {1, 0, 0}, {1, 1, 0.5}, {0, 1, 0}}, {});
     }},
    {"turn of quad at corner 2 = -",
     [] {
       quad({Vec3{0, 0, 0}, {1, 0, 0}, {0.2, 0.2, 0}, {0, 1, 0}}, {});
     }},
    {"fibre diameter = 0 m", [] { fibre_network(std::vector<Segment>{}, 0, {}); }},
    {"end of fibre 0.z = inf m",
     [] {
       fibre_network(std::vector{Segment{{0, 0, 0}, {0, 0, INFINITY}}}, 1, {});
     }},
};

TEST(Walls, RefuseABadArgumentWithItsNameAndValue) {
  for (const auto& [expected, call] : kRefused) {
    try {
      call();
      ADD_FAILURE() << "nothing thrown, expected " << expected;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(expected), std::string::npos)
          << error.what() << "\nexpected " << expected;
    }
  }
}

}  // namespace
}  // namespace scree
