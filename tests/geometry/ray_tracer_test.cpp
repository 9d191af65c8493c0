// Rays against bodies: distances known in closed form, and Embree against its brute-force twin.
#include "geometry/ray_tracer.h"

#include <gtest/gtest.h>

#include "tests/geometry/random_geometry.h"

namespace scree {
namespace {

using MakeTracer = std::unique_ptr<RayTracer> (*)(TracedBodies);
constexpr MakeTracer kTracers[] = {make_embree_tracer, make_brute_force_tracer};

Vec3f to_float(const Vec3& v) { return {float(v.x), float(v.y), float(v.z)}; }

Hit closest(const RayTracer& tracer, const Vec3& from, const Vec3& direction) {
  const Ray ray{tracer.local(from), 0, to_float(unit(direction))};
  Hit hit;
  tracer.closest({&ray, 1}, {&hit, 1});
  return hit;
}

struct Bodies {
  std::vector<Ball> balls;
  std::vector<Capsule> capsules;
  std::vector<Quad> quads;
  TracedBodies traced() const { return {balls, capsules, quads}; }
};

Bodies random_bodies(RandomGeometry& random, int count) {
  Bodies bodies;
  for (int k = 0; k < count; ++k) {
    bodies.balls.push_back({random.in_cube(1), random.between(0.01, 0.1)});
    const Vec3 a = random.in_cube(1);
    bodies.capsules.push_back({{a, a + random.between(0, 0.5) * random.direction()}, random.between(0.01, 0.05)});
    if (k % 10 == 0) bodies.quads.push_back(k % 20 ? random.quad() : random.triangle());
  }
  return bodies;
}

std::vector<Ray> random_rays(RandomGeometry& random, int count) {
  std::vector<Ray> rays;
  for (int k = 0; k < count; ++k) {
    const Vec3 from = random.in_cube(2), to = random.in_cube(1);
    rays.push_back({to_float(from), float(random.between(0, 1)), to_float(unit(to - from)),
                    k % 2 ? std::numeric_limits<float>::infinity() : float(random.between(0, 3))});
  }
  return rays;
}

TEST(RayTracer, ABallIsHitWhereTheRayEntersIt) {
  const Bodies b{{{{1, 2, 3}, 0.5}}, {}, {}};
  for (const MakeTracer make : kTracers) {
    const auto tracer = make(b.traced());
    const Hit hit = closest(*tracer, {1, -7, 3}, {0, 1, 0});
    EXPECT_EQ(hit.body, (BodyId{Shape::ball, 0}));
    EXPECT_NEAR(hit.distance, 8.5, 1e-6);
    // Off the axis by 0.3: half a chord of sqrt(0.5^2 - 0.3^2) = 0.4.
    EXPECT_NEAR(closest(*tracer, {1.3, -7, 3}, {0, 1, 0}).distance, 8.6, 1e-5);
    EXPECT_EQ(closest(*tracer, {1.5001, -7, 3}, {0, 1, 0}).body.shape, Shape::none);
  }
}

TEST(RayTracer, ACapsuleIsHitOnItsBarrelAtItsEndsAndAlongItsAxis) {
  const Bodies b{{}, {{{{-1, 0, 0}, {1, 0, 0}}, 0.25}}, {}};
  for (const MakeTracer make : kTracers) {
    const auto tracer = make(b.traced());
    EXPECT_NEAR(closest(*tracer, {0.7, -5, 0}, {0, 1, 0}).distance, 4.75, 1e-6);
    EXPECT_NEAR(closest(*tracer, {-5, 0, 0}, {1, 0, 0}).distance, 3.75, 1e-6);  // on the axis
    EXPECT_NEAR(closest(*tracer, {-5, 0.15, 0}, {1, 0, 0}).distance, 3.8, 1e-6);
    EXPECT_EQ(closest(*tracer, {-5, 0.2501, 0}, {1, 0, 0}).body.shape, Shape::none);
    EXPECT_NEAR(closest(*tracer, {1.15, -5, 0}, {0, 1, 0}).distance, 4.8, 1e-5);  // a rounded end
    const Vec3f normal = tracer->normal({Shape::capsule, 0}, tracer->local({0.3, 0, 0.25}));
    EXPECT_NEAR(normal.z, 1, 1e-6);
  }
}

TEST(RayTracer, AQuadIsHitInsideItsEdgesOnly) {
  const Bodies b{{}, {}, {{{{0, 0, 0}, {2, 0, 0}, {2, 0, 1}, {0, 0, 1}}}}};
  for (const MakeTracer make : kTracers) {
    const auto tracer = make(b.traced());
    EXPECT_NEAR(closest(*tracer, {1.9, -3, 0.9}, {0, 1, 0}).distance, 3, 1e-6);
    EXPECT_NEAR(closest(*tracer, {1.9, 3, 0.9}, {0, -1, 0}).distance, 3, 1e-6);
    EXPECT_EQ(closest(*tracer, {2.1, -3, 0.9}, {0, 1, 0}).body.shape, Shape::none);
  }
}

// A surface would shade itself otherwise.
TEST(RayTracer, ABodyThatTheRayStartsInsideOfIsNotSeen) {
  const Bodies b{{{{0, 0, 0}, 1}, {{0, 5, 0}, 1}}, {}, {}};
  for (const MakeTracer make : kTracers) {
    const Hit hit = closest(*make(b.traced()), {0, 0, 0}, {0, 1, 0});
    EXPECT_EQ(hit.body, (BodyId{Shape::ball, 1}));
  }
}

TEST(RayTracer, TheDeepestBodyContainsThePoint) {
  const Bodies b{{{{0, 0, 0}, 1}, {{0.5, 0, 0}, 1}}, {{{{0, 3, 0}, {0, 9, 0}}, 0.5}}, {}};
  for (const MakeTracer make : kTracers) {
    const auto tracer = make(b.traced());
    EXPECT_EQ(tracer->containing(tracer->local({0.1, 0, 0})), (BodyId{Shape::ball, 0}));
    EXPECT_EQ(tracer->containing(tracer->local({0.4, 0, 0})), (BodyId{Shape::ball, 1}));
    EXPECT_EQ(tracer->containing(tracer->local({0.4, 8, 0})), (BodyId{Shape::capsule, 0}));
    EXPECT_EQ(tracer->containing(tracer->local({0.6, 8, 0})), std::nullopt);
  }
}

TEST(RayTracer, ABodyThatCannotBeDrawnIsRefused) {
  const Bodies flat{{{{0, 0, 0}, 0}}, {}, {}}, lost{{{{0, NAN, 0}, 1}}, {}, {}};
  EXPECT_THROW(make_embree_tracer(flat.traced()), std::invalid_argument);
  EXPECT_THROW(make_embree_tracer(lost.traced()), std::invalid_argument);
}

class AgainstBruteForce : public ::testing::TestWithParam<int> {};

void expect_alike(const RayTracer& fast_tracer, const RayTracer& slow_tracer, RandomGeometry& random, bool any_hit) {
  const RayTracer *fast = &fast_tracer, *slow = &slow_tracer;
  const std::vector<Ray> rays = random_rays(random, 1003);
  std::vector<Hit> hits(rays.size()), expected(rays.size());
  fast->closest(rays, hits), slow->closest(rays, expected);
  std::vector<uint8_t> blocked(rays.size()), expected_blocked(rays.size());
  fast->any(rays, blocked), slow->any(rays, expected_blocked);
  size_t hit = 0;
  for (size_t k = 0; k < rays.size(); ++k) {
    ASSERT_EQ(hits[k].body, expected[k].body) << k;
    ASSERT_EQ(hits[k].distance, expected[k].distance) << k;
    ASSERT_EQ(blocked[k], expected_blocked[k]) << k;
    hit += hits[k].body.shape != Shape::none;
    const Vec3f x = to_float(random.in_cube(1));
    ASSERT_EQ(fast->containing(x), slow->containing(x));
  }
  EXPECT_TRUE(!any_hit || hit > 20) << hit;
  std::vector<Crossing> crossings, expected_crossings;
  fast->all(rays, crossings), slow->all(rays, expected_crossings);
  ASSERT_EQ(crossings.size(), expected_crossings.size());
  for (size_t k = 0; k < crossings.size(); ++k) {
    EXPECT_EQ(crossings[k].ray, expected_crossings[k].ray);
    EXPECT_EQ(crossings[k].hit.body, expected_crossings[k].hit.body);
    EXPECT_EQ(crossings[k].hit.distance, expected_crossings[k].hit.distance);
  }
}

TEST_P(AgainstBruteForce, ClosestAnyAllAndContaining) {
  RandomGeometry random(7);
  const Bodies bodies = random_bodies(random, GetParam());
  const auto slow = make_brute_force_tracer(bodies.traced());
  expect_alike(*make_embree_tracer(bodies.traced()), *slow, random, GetParam() > 0);
  for (const size_t together : {2, 7}) {
    SCOPED_TRACE(together);
    expect_alike(*make_embree_tracer(bodies.traced(), together), *slow, random, GetParam() > 0);
  }
}

TEST(RayTracer, TakesBallsInTwosWhereMillionsLieInOrder) {
  const size_t many = 4'000'000;
  std::vector<Ball> balls;
  for (size_t k = 0; k < many; ++k) balls.push_back({{1e-3 * static_cast<double>(k), 0, 0}, 5e-4});
  EXPECT_EQ(balls_together(balls), 2u);
  EXPECT_EQ(balls_together(std::span(balls).first(many - 1)), 1u);
  for (size_t k = 0; k < many / 2; k += 2) std::swap(balls[k], balls[many - 1 - k]);  // far from their neighbours
  for (size_t k = 0; k < many / 2; k += 4) std::swap(balls[k + 1], balls[many / 2 + k]);
  EXPECT_EQ(balls_together(balls), 1u);
}

INSTANTIATE_TEST_SUITE_P(Bodies, AgainstBruteForce, ::testing::Values(0, 1, 10, 400));

}  // namespace
}  // namespace scree
