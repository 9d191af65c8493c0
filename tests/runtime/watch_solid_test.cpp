// What the lists of the solid must hold: particles that the skin dwarfs, and more fibres than there are slots for.
#include <gtest/gtest.h>

#include "kernels/contacts.h"
#include "tests/oracle/beds.h"

namespace scree {
namespace {

const Bounds kBox{{-0.01, -0.01, -0.01}, {0.01, 0.01, 0.01}};
constexpr double kSmall = 0.1 * kRadius;
constexpr double kSkin = 1.2 * kRadius;  // half of it is six radii of the small ones
constexpr double kSmallStep = 2.5e-7;    // s

Case case_with_floor(double youngs_modulus) {
  Case c = ceramic_case(kBox);
  for (Material& m : c.materials) m.youngs_modulus = youngs_modulus;
  c.time.step = kSmallStep;
  c.solid.walls = {"floor"};
  c.solid.primitives = plane({0, 0, 0}, {0, 0, 1}, kBox, {1, 0});
  return c;
}

// Small ones at all heights up to a few skins, falling fast, beside a large one at rest that makes the skin wide.
std::vector<ParticleState> rain() {
  std::vector<ParticleState> all{grain({0.005, 0.005, 0.002})};
  Random random(1);
  for (int k = 0; k < 400; ++k) {
    const Vec3 at{-0.006 + 5e-4 * (k % 20), -0.006 + 5e-4 * (k / 20), random.between(1.1 * kSmall, 2 * kSkin)};
    all.push_back(grain(at, kSmall, {0, 0, -random.between(0.1, 0.6)}));
  }
  return all;
}

// Between two rebuilds a small one falls through several of its diameters; it must be in the lists before it arrives.
TEST(Watch, a_particle_smaller_than_the_skin_does_not_cross_a_wall_between_rebuilds) {
  const auto engine = make_engine(case_with_floor(1e7), with_skin(kSkin));
  const std::vector<ParticleState> drops = rain();
  engine->insert(drops);
  for (int k = 0; k < 400; ++k) {
    run_steps(*engine, 10);
    for (const ParticleState& p : engine->particles()) ASSERT_GT(p.position.z, 0.5 * p.radius) << "particle " << p.id;
  }
  EXPECT_GT(engine->counters().rebuilds, 3u);
  int arrived = 0;
  for (const ParticleState& p : engine->particles()) {
    const ParticleState& before = drops[p.id];
    if (before.velocity.z == 0) continue;  // the large one
    const double fall = (before.position.z - before.radius) / -before.velocity.z;
    if (!(fall < 0.9 * engine->counters().steps * kSmallStep)) continue;
    ++arrived;
    EXPECT_GT(p.velocity.z, 0) << "particle " << p.id << " did not bounce";
  }
  EXPECT_GT(arrived, 200);
}

TEST(Watch, a_small_particle_that_a_soft_wall_does_not_hold_stops_the_run) {
  const auto engine = make_engine(case_with_floor(1e2), with_skin(kSkin));
  engine->insert(rain());
  try {
    run_steps(*engine, 4000);
    FAIL() << "nothing noticed";
  } catch (const RunError& error) {
    EXPECT_NE(std::string(error.what()).find("'floor'"), std::string::npos) << error.what();
  }
  for (const ParticleState& p : engine->particles()) EXPECT_GT(p.position.z, -p.radius) << "particle " << p.id;
}

// A fan of fibres round one point.
Case case_with_fibres(int count) {
  Case c = ceramic_case(kBox);
  c.solid.walls = {"fan"};
  for (int k = 0; k < count; ++k) {
    const double angle = 2 * M_PI * k / count;
    const Segment axis{{0, 0, 0}, {1e-3 * std::cos(angle), 1e-3 * std::sin(angle), 0}};
    for (const Primitive& p : fibre_network(std::span(&axis, 1), 2e-5, {1, 0})) c.solid.primitives.push_back(p);
  }
  return c;
}

TEST(Watch, more_fibres_near_a_particle_than_there_are_slots_stop_the_run) {
  const Vec3 at{0, 0, kRadius + 1e-5};
  const auto fits = make_engine(case_with_fibres(kMaxSlots)), crowded = make_engine(case_with_fibres(kMaxSlots + 1));
  fits->insert(std::vector{grain({0.005, 0, 0}), grain(at)});
  EXPECT_NO_THROW(fits->step());
  crowded->insert(std::vector{grain({0.005, 0, 0}), grain(at)});
  try {
    crowded->step();
    FAIL() << "nothing noticed";
  } catch (const RunError& error) {
    for (const char* part : {"particle 1 ", "more than 192 fibres", "smaller [neighbour] skin"})
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    ASSERT_TRUE(error.where.has_value());
    EXPECT_LT(norm(*error.where - at), 1e-9);
  }
}

}  // namespace
}  // namespace scree
