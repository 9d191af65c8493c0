#include "geometry/solid_index.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <thread>

#include "geometry/bounds.h"
#include "geometry/octet_lattice.h"
#include "geometry/walls.h"
#include "tests/geometry/random_geometry.h"

namespace scree {
namespace {

using Found = std::vector<uint32_t>;

void append(Solid& solid, const Primitives& primitives) {
  solid.primitives.insert(solid.primitives.end(), primitives.begin(), primitives.end());
}

// The paper's exchanger: 1,460 fibres, channel, hopper and lid.
Solid paper_exchanger(const Vec3& shift = {0, 0, 0}) {
  Solid solid;
  append(solid, fibre_primitives(octet_lattice(0.01, {5, 1, 10}, shift - Vec3{0.025, 0.005, 0}), 1e-3, {}));
  append(solid, channel({shift + Vec3{-0.025, -0.005, 0}, shift + Vec3{0.025, 0.005, 0.1}}, {}));
  append(solid, frustum({.centre_x = shift.x,
                         .centre_y = shift.y,
                         .z0 = shift.z + 0.1,
                         .bottom_x = 0.05,
                         .bottom_y = 0.01,
                         .z1 = shift.z + 0.22,
                         .top_x = 0.08,
                         .top_y = 0.04},
                        {}));
  append(solid, rectangle(shift + Vec3{-0.025, -0.005, 0.1}, {0.05, 0, 0}, {0, 0.01, 0}, {}));
  return solid;
}

class Pair {
 public:
  explicit Pair(const Solid& solid) : fast_(make_embree_index(solid)), oracle_(make_brute_force_index(solid)) {}

  // The common answer.
  Found expect_equal(const Vec3& x, double reach) const {
    Found fast, oracle;
    fast_->query(x, reach, fast);
    oracle_->query(x, reach, oracle);
    EXPECT_EQ(fast, oracle) << fmt::format("x = ({}, {}, {}), reach = {}", x.x, x.y, x.z, reach);
    return oracle;
  }

 private:
  std::unique_ptr<SolidIndex> fast_, oracle_;
};

void expect_equal_at_random_points(const Solid& solid, uint32_t seed, int points) {
  const Pair index(solid);
  const Bounds around = inflated(bounds_of(solid), 1e-3);
  RandomGeometry random(seed);
  size_t found = 0;
  for (int k = 0; k < points; ++k) {
    const Vec3 x = random.in_box(around);
    for (const double reach : {0.0, 3e-4, 2e-3}) found += index.expect_equal(x, reach).size();
  }
  EXPECT_GT(found, size_t(points) / 2);  // the comparison compared something
}

TEST(SolidIndex, AgreesWithItsTwinInThePapersExchanger) { expect_equal_at_random_points(paper_exchanger(), 41, 3000); }

TEST(SolidIndex, AgreesWithItsTwinFarFromTheOrigin) {
  expect_equal_at_random_points(paper_exchanger({1000, -2000, 500}), 42, 1000);
}

TEST(SolidIndex, AgreesWithItsTwinExactlyOnNodesAndAxes) {
  const OctetLattice lattice = octet_lattice(0.01, {2, 2, 2}, {0, 0, 0});
  const Pair index(Solid{{}, fibre_primitives(lattice, 1e-3, {})});
  for (const Vec3& node : lattice.nodes) EXPECT_GE(index.expect_equal(node, 0).size(), 3u);
  for (const Segment& axis : fibre_axes(lattice)) EXPECT_EQ(index.expect_equal(0.5 * (axis.a + axis.b), 0).size(), 1u);
}

// The answer turns on the last bit here: x is exactly `reach` from the surface, or one bit nearer or further.
TEST(SolidIndex, AgreesWithItsTwinAtTheEdgeOfReach) {
  const Solid solid = paper_exchanger({0.3, 0.7, 0.1});
  const Pair index(solid);
  RandomGeometry random(43);
  for (int k = 0; k < 3000; ++k) {
    const Vec3 x = random.in_box(bounds_of(solid));
    const auto nearest = uint32_t(random.between(0, double(solid.primitives.size())));
    const double reach = distance(solid.primitives[nearest], x);
    if (reach > 5e-3 && k % 10 != 0) continue;
    const Found found = index.expect_equal(x, reach);
    EXPECT_TRUE(std::ranges::binary_search(found, nearest));
    EXPECT_FALSE(std::ranges::binary_search(index.expect_equal(x, std::nextafter(reach, -1.0)), nearest));
    index.expect_equal(x, std::nextafter(reach, 1.0));
  }
}

// Touching from outside where bounds and surface meet, the worst case for bounds in float: far from the index's centre
// a float is coarser than the reach.
TEST(SolidIndex, FindsAPrimitiveThatReachJustTouches) {
  RandomGeometry random(44);
  Solid solid;
  for (int k = 0; k < 500; ++k) {
    const Vec3 centre = random.in_cube(1000);
    solid.primitives.push_back({Segment{centre, centre}, random.between(1e-4, 1)});
  }
  const Pair index(solid);
  for (uint32_t k = 0; k < solid.primitives.size(); ++k) {
    const Primitive& sphere = solid.primitives[k];
    const double away = sphere.radius + std::pow(10, random.between(-7, 0));
    for (const Vec3& side :
         {Vec3{away, 0, 0}, {-away, 0, 0}, {0, away, 0}, {0, -away, 0}, {0, 0, away}, {0, 0, -away}}) {
      const Vec3 x = std::get<Segment>(sphere.skeleton).a + side;
      EXPECT_TRUE(std::ranges::binary_search(index.expect_equal(x, distance(sphere, x)), k));
    }
  }
}

TEST(SolidIndex, AgreesWithItsTwinForTinyAndHugePrimitivesTogether) {
  RandomGeometry random(45);
  Solid solid;
  for (int k = 0; k < 400; ++k) {
    const double size = std::pow(10, random.between(-7, 6));
    const Vec3 centre = random.in_cube(1);
    solid.primitives.push_back({Segment{centre, centre + size * random.direction()}, size * random.between(0, 1)});
    Quad quad = random.quad();
    for (Vec3& corner : quad.corners) corner = centre + size * corner;
    solid.primitives.push_back({quad, 0});
    Revolution round = random.revolution();
    round = {centre, round.axis, size * round.r0, size * round.h0, size * round.r1, size * round.h1};
    solid.primitives.push_back({round, 0});
  }
  const Pair index(solid);
  for (int k = 0; k < 1000; ++k)
    for (const double reach : {0.0, 1e-6, 1e-2, 10.0, 1e5}) index.expect_equal(random.in_cube(2), reach);
}

TEST(SolidIndex, FindsAllOfManyCoincidentPrimitives) {
  const Primitive fibre{Segment{{0, 0, 0}, {1, 1, 1}}, 0.1}, wall{Quad{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}}};
  Solid solid;
  for (int k = 0; k < 50; ++k) solid.primitives.insert(solid.primitives.end(), {fibre, wall});
  EXPECT_EQ(Pair(solid).expect_equal({0.5, 0.5, 0.5}, 0).size(), 50u);
  EXPECT_EQ(Pair(solid).expect_equal({0.5, 0.5, 0.5}, 0.6).size(), 100u);
}

TEST(SolidIndex, WithZeroReachFindsWhatHoldsThePoint) {
  const Solid solid{
      {},
      {Primitive{Segment{{0, 0, 0}, {1, 0, 0}}, 0.5}, Primitive{Quad{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}}}}};
  const Pair index(solid);
  EXPECT_EQ(index.expect_equal({0.5, 0.5, 0}, 0), (Found{0, 1}));  // on both surfaces
  EXPECT_EQ(index.expect_equal({0.5, 0.25, 0.25}, 0), Found{0});
  EXPECT_EQ(index.expect_equal({0.5, 0.75, 0}, 0), Found{1});
  EXPECT_EQ(index.expect_equal({0.5, 0.75, 0.25}, 0), Found{});
}

TEST(SolidIndex, WithNegativeReachFindsWhatHoldsThePointDeeply) {
  const Pair index(Solid{{}, {Primitive{Segment{{0, 0, 0}, {1, 0, 0}}, 0.5}}});
  EXPECT_EQ(index.expect_equal({0.5, 0.25, 0}, -0.25), Found{0});
  EXPECT_EQ(index.expect_equal({0.5, 0.25, 0}, -0.26), Found{});
}

TEST(SolidIndex, WithInfiniteReachFindsEverything) {
  const Solid solid = paper_exchanger();
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(Pair(solid).expect_equal({0, 0, 0}, infinity).size(), solid.primitives.size());
  EXPECT_EQ(Pair(solid).expect_equal({1e30, 0, 0}, 2e30).size(), solid.primitives.size());
}

TEST(SolidIndex, OfAnEmptySolidFindsNothing) { EXPECT_EQ(Pair(Solid{}).expect_equal({0, 0, 0}, 1e3), Found{}); }

TEST(SolidIndex, AppendsToWhatWasFoundBefore) {
  const auto index = make_embree_index(paper_exchanger());
  Found found{9999, 3};
  index->query({0, 0, 0.05}, 2e-3, found);
  ASSERT_GT(found.size(), 3u);
  EXPECT_EQ(found[0], 9999u);
  EXPECT_EQ(found[1], 3u);
  EXPECT_TRUE(std::is_sorted(found.begin() + 2, found.end()));
}

TEST(SolidIndex, AnswersThreadsAtTheSameTime) {
  const Solid solid = paper_exchanger();
  const auto fast = make_embree_index(solid), oracle = make_brute_force_index(solid);
  std::vector<int> wrong(4);
  std::vector<std::thread> threads;
  for (uint32_t t = 0; t < 4; ++t) {
    threads.emplace_back([&, t] {
      RandomGeometry random(50 + t);
      for (int k = 0; k < 500; ++k) {
        const Vec3 x = random.in_box(bounds_of(solid));
        Found a, b;
        fast->query(x, 1e-3, a);
        oracle->query(x, 1e-3, b);
        wrong[t] += a != b;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, std::vector<int>(4));
}

// Embree likes denormals flushed to zero; a run's bits must not depend on whether an index was built.
TEST(SolidIndex, LeavesTheFloatingPointModeAlone) {
  const auto index = make_embree_index(paper_exchanger());
  Found found;
  index->query({0, 0, 0.05}, 2e-3, found);
  const volatile double smallest = std::numeric_limits<double>::min();
  EXPECT_GT(smallest / 2, 0);
}

TEST(SolidIndex, RefusesAPrimitiveThatIsNotFiniteOrTooFarForFloats) {
  for (const double bad : {double(NAN), double(INFINITY), -double(INFINITY)}) {
    const Solid solid{{}, {Primitive{Segment{{0, 0, 0}, {0, 0, bad}}, 0.1}}};
    EXPECT_THROW(make_embree_index(solid), std::invalid_argument);
    EXPECT_THROW(make_brute_force_index(solid), std::invalid_argument);
  }
  const Solid far{{}, {Primitive{Segment{{0, 0, 0}, {0, 0, 1e30}}, 0.1}}};
  EXPECT_THROW(make_embree_index(far), std::invalid_argument);
}

// The property this index is for: a query costs far less than looking at every primitive.
TEST(SolidIndex, IsTenTimesFasterThanItsTwinInThePapersExchanger) {
  const Solid solid = paper_exchanger();
  RandomGeometry random(46);
  std::vector<Vec3> points;
  for (int k = 0; k < 20000; ++k) points.push_back(random.in_box({{-0.025, -0.005, 0}, {0.025, 0.005, 0.1}}));
  const auto seconds_per_query = [&](const SolidIndex& index, size_t count) {
    Found found;
    const auto start = std::chrono::steady_clock::now();
    for (size_t k = 0; k < count; ++k) {
      found.clear();
      index.query(points[k], 3e-4, found);
    }
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() / double(count);
  };
  const double fast = seconds_per_query(*make_embree_index(solid), points.size());
  const double slow = seconds_per_query(*make_brute_force_index(solid), 2000);
  RecordProperty("embree_ns_per_query", fmt::format("{:.0f}", 1e9 * fast));
  RecordProperty("brute_force_ns_per_query", fmt::format("{:.0f}", 1e9 * slow));
  EXPECT_LT(10 * fast, slow);
}

}  // namespace
}  // namespace scree
