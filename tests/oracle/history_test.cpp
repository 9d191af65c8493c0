// A list rebuild is bookkeeping: contacts keep what they remember, whatever is sorted, inserted, removed or opened
// elsewhere.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/oracle/beds.h"

namespace scree {
namespace {

// Pairs of grains that meet at random angles and speeds, each pair alone: every bit of a collision must be the same
// whether the lists are rebuilt in mid-contact or never, whichever grain comes first in memory.
TEST(History, OfACollisionDoesNotDependOnRebuilds) {
  for (const RollingModel rolling : {RollingModel::cdt, RollingModel::epsd2}) {
    Case c = ceramic_case({{-1, -1, -1}, {1, 1, 1}});
    c.contact.rolling = rolling;
    std::vector<ParticleState> grains;
    Random random(21);
    for (int k = 0; k < 700; ++k) {
      const Vec3 x = 2e-3 * Vec3{double(k % 9), double(k / 9 % 9), double(k / 81)};
      const Vec3 along = unit(random.in({{-1, -1, -1}, {1, 1, 1}})), across = perpendicular_to(along);
      const double speed = random.between(0.01, 0.2), a = random.between(0.5, 1) * kRadius,
                   b = random.between(0.5, 1) * kRadius;
      grains.push_back(grain(x, a, speed * along));
      grains.push_back(grain(x + (a + b + random.between(0, 5e-5)) * along + random.between(-0.7, 0.7) * a * across, b,
                             -speed * along));
      for (int g = 0; g < 2; ++g) grains[grains.size() - 1 - g].spin = random.in({{-300, -300, -300}, {300, 300, 300}});
    }
    uint64_t hash = 0, most = 0, least = ~0ull;
    for (const double skin : {3e-4, 1e-4, 1e-5, 1e-6}) {
      const auto engine = make_engine(c, with_skin(skin));
      engine->insert(grains);
      run_steps(*engine, 250);
      if (hash == 0) hash = engine->state_hash();
      EXPECT_EQ(engine->state_hash(), hash) << "skin " << skin << ", " << engine->counters().rebuilds << " rebuilds";
      most = std::max(most, engine->counters().rebuilds), least = std::min(least, engine->counters().rebuilds);
    }
    EXPECT_GE(most, 240u);
    EXPECT_LE(least, 4u);
  }
}

// Something far away that is fast, so that the lists of all are rebuilt often.
ParticleState bullet(const Vec3& x) { return grain(x, kRadius, {0.8, 0, 0}); }

// A slope under two bodies that only memory holds still: one sphere, and another that leans on it.
Case slope_case(double angle) {
  Case c = ceramic_case({{-0.02, -0.02, -0.001}, {0.02, 0.02, 0.02}}, {'x'});
  c.gravity = {9.81 * std::sin(angle), 0, -9.81 * std::cos(angle)};
  c.solid.walls = {"slope", "far wall"};
  c.solid.primitives = rectangle({-0.02, -0.01, 0}, {0.04, 0, 0}, {0, 0.02, 0}, {1, 0});
  for (const Primitive& p : rectangle({-0.02, -0.01, 0.018}, {0.04, 0, 0}, {0, 0.02, 0}, {1, 1}))
    c.solid.primitives.push_back(p);
  return c;
}

TEST(History, OfASphereStuckOnASlopeOutlivesRebuilds) {
  for (const Precision precision : {Precision::mixed, Precision::reference}) {
    Case c = slope_case(0.2);
    c.contact.precision = precision;
    const ParticleState stuck = grain({0, 0, kRadius});
    const auto alone = make_engine(c, with_skin(3e-4)), disturbed = make_engine(c, with_skin(1e-6));
    alone->insert(std::vector{stuck});
    disturbed->insert(std::vector{stuck, bullet({0, 0.005, 0.015})});
    for (int k = 0; k < 4; ++k) {
      run_steps(*alone, 500), run_steps(*disturbed, 500);
      const ParticleState a = by_id(*alone)[0], b = by_id(*disturbed)[0];
      for (const Vec3& d : {a.position - b.position, a.velocity - b.velocity, a.spin - b.spin}) EXPECT_EQ(norm(d), 0);
    }
    EXPECT_LE(alone->counters().rebuilds, 2u);
    EXPECT_GT(disturbed->counters().rebuilds, 1500u);
    // Held: sliding freely it would have gone (1/2) g sin(0.2) t^2 = 97 um.
    EXPECT_LT(std::abs(by_id(*disturbed)[0].position.x), 2e-6);
  }
}

// A pyramid of four: nothing but friction holds the three below together.
std::vector<ParticleState> pyramid(const Vec3& at) {
  std::vector<ParticleState> four;
  const double side = 2 * kRadius, ring = side / std::sqrt(3.0);
  for (int k = 0; k < 3; ++k)
    four.push_back(grain(at + Vec3{ring * std::cos(2 * M_PI * k / 3), ring * std::sin(2 * M_PI * k / 3), kRadius}));
  four.push_back(grain(at + Vec3{0, 0, kRadius + side * std::sqrt(2.0 / 3.0)}));
  return four;
}

double height_of_top(const Engine& engine) { return by_id(engine)[3].position.z; }

TEST(History, HoldsAPyramidThroughRebuilds) {
  const Case c = slope_case(0);
  double height[2];
  for (const bool disturbed : {false, true}) {
    const auto engine = make_engine(c, with_skin(disturbed ? 1e-6 : 2e-4));
    engine->insert(pyramid({0, 0, 0}));
    if (disturbed) engine->insert(std::vector{bullet({0, 0.005, 0.015})});
    run_steps(*engine, 4000);
    EXPECT_TRUE(!disturbed || engine->counters().rebuilds > 3000u);
    height[disturbed] = height_of_top(*engine);
  }
  EXPECT_GT(height[0], 0.98 * (kRadius + 2 * kRadius * std::sqrt(2.0 / 3.0)));
  EXPECT_NEAR(height[1], height[0], 1e-11);
  // Without friction it falls: the pyramid is a test of memory.
  Case slippery = c;
  for (MaterialPair& p : slippery.pairs) p.sliding_friction = p.rolling_friction = 0;
  const auto engine = make_engine(slippery);
  engine->insert(pyramid({0, 0, 0}));
  run_steps(*engine, 4000);
  EXPECT_LT(height_of_top(*engine), 2 * kRadius);
}

TEST(History, IsNotDisturbedByInsertionRemovalOrAnOpenedWallElsewhere) {
  const Case c = slope_case(0.05);
  const auto plain = make_engine(c), disturbed = make_engine(c);
  for (Engine* engine : {plain.get(), disturbed.get()}) {
    engine->insert(pyramid({0, 0, 0}));
    run_steps(*engine, 2000);
  }
  const std::vector<ParticleState> before = by_id(*plain);
  disturbed->set_removal([](const ParticleState& p) { return p.position.z > 0.016 ? 0 : -1; });
  for (int k = 0; k < 10; ++k) {
    disturbed->insert(LooseBed{6, 6, 4}.particles({-0.018 + 0.0035 * k, 0.003, 0.0153}, 50 + k));
    run_steps(*disturbed, 7);
    if (k == 4) disturbed->open_walls({1});
  }
  run_steps(*plain, 70);
  EXPECT_GT(disturbed->counters().removed, 100u);
  const auto a = by_id(*plain), b = by_id(*disturbed);
  for (size_t k = 0; k < 4; ++k) {
    EXPECT_LT(norm(a[k].position - b[k].position), 1e-12);
    EXPECT_LT(norm(a[k].velocity - b[k].velocity), 1e-8);  // of g dt = 5e-5 m/s
    EXPECT_LT(norm(a[k].position - before[k].position), 1e-7);
  }
}

// The same bed sheared by a moving floor, with few and with very many rebuilds: rounding may differ (the order of
// additions follows the lists), the physics may not.
TEST(History, OfAShearedBedDoesNotDependOnTheSkin) {
  const LooseBed bed{8, 8, 8, kRadius, kRadius, 2.6};
  const auto settling = make_engine(bed_case(bed));
  settling->insert(bed.particles({0, 0, 0}, 31));
  run_steps(*settling, 6000);
  Case c = bed_case(bed);
  c.solid.primitives[0].velocity = {0.02, 0, 0};
  const std::vector<ParticleState> start = by_id(*settling);
  std::vector<std::vector<ParticleState>> ends;
  uint64_t rebuilds[2];
  for (const double skin : {1e-6, 2e-4}) {
    const auto engine = make_engine(c, with_skin(skin));
    engine->insert(start);
    run_steps(*engine, 400);
    rebuilds[ends.size()] = engine->counters().rebuilds;
    ends.push_back(by_id(*engine));
  }
  EXPECT_GT(rebuilds[0], 40u);
  EXPECT_LT(rebuilds[1], 4u);
  std::vector<double> position, velocity;
  double moved = 0;
  const Vec3 period = periods(c);
  for (size_t k = 0; k < start.size(); ++k) {
    const auto apart = [&](const std::vector<ParticleState>& a, const std::vector<ParticleState>& b) {
      const Vec3 d = a[k].position - b[k].position;
      return norm(Vec3{std::remainder(d.x, period.x), std::remainder(d.y, period.y), d.z});
    };
    position.push_back(apart(ends[0], ends[1]));
    moved = std::max(moved, apart(ends[0], start));
    velocity.push_back(norm(ends[0][k].velocity - ends[1][k].velocity));
  }
  std::ranges::sort(position), std::ranges::sort(velocity);
  const size_t most = start.size() * 95 / 100;
  fmt::print("sheared bed: 95 % within {:.3g} m and {:.3g} m/s, all within {:.3g} m and {:.3g} m/s; moved {:.3g} m\n",
             position[most], velocity[most], position.back(), velocity.back(), moved);
  EXPECT_GT(moved, 1e-5);
  EXPECT_LT(position[most], 1e-9);
  EXPECT_LT(velocity[most], 1e-5);
  // A contact that slides or opens a step earlier makes a grain's way differ, not the flow.
  EXPECT_LT(position.back(), 1e-3 * moved);
}

}  // namespace
}  // namespace scree
