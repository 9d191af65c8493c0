// A sphere on a plane z = 0 that slides, rolls and stops. Inclines are made by tilting gravity.
#include "tests/laws/law_test.h"

namespace scree {
namespace {

constexpr double kRadius = 0x1p-9, kDensity = 2500, kGravity = 9.81;

struct Plane {
  double sliding_friction = 0.5, rolling_friction = 0;
  RollingModel rolling = RollingModel::none;
  double slope_deg = 0;  // downwards along +x
  double youngs_modulus = 1e7;
  double restitution = 0.05;  // what is not at rest at the start soon is
};

class Rolling : public LawTest {
 protected:
  Case plane_case(const Plane& plane, double step = 1e-5) const {
    Case c = empty_case(step, GetParam());
    add_material(c, {"grain", kDensity, plane.youngs_modulus, 0.3});
    c.pairs = {{0, 0, plane.restitution, plane.sliding_friction, plane.rolling_friction}};
    c.contact.rolling = plane.rolling;
    add_kind(c, 0, kRadius);
    add_solid(c, floor_at(0, 2, 0));
    const double slope = degrees(plane.slope_deg);
    c.gravity = {kGravity * std::sin(slope), 0, -kGravity * std::cos(slope)};
    return c;
  }
  static double mass() { return sphere_mass(kRadius, kDensity); }
  // Hertz: m g = 4/3 E* sqrt(R) overlap^1.5.
  static double resting_overlap(const Case& c) {
    const double youngs = constants_of(c, 0, 0).effective_youngs;
    return std::pow(-3 * mass() * c.gravity.z / (4 * youngs * std::sqrt(kRadius)), 2.0 / 3.0);
  }
  static double arm(const Case& c) { return kRadius - 0.5 * resting_overlap(c); }
  static ParticleState resting(const Case& c, double speed = 0, double spin = 0) {
    return sphere(c, 0, {0, 0, kRadius - resting_overlap(c)}, {speed, 0, 0}, {0, spin, 0});
  }
  // Constant torque mu_r |F_n| R against a rolling sphere: friction F at the lever arm c and the torque M turn it,
  // m a = -F, I a/c = F c - M.
  static double rolling_resistance(const Case& c, double rolling_friction) {
    const double moment = rolling_friction * mass() * -c.gravity.z * kRadius,
                 inertia = 0.4 * mass() * kRadius * kRadius;
    return moment / (mass() * arm(c) + inertia / arm(c));
  }
};
SCREE_IN_BOTH_PRECISIONS(Rolling);

TEST_P(Rolling, HertzOverlapAtRest) {
  for (const double youngs : {1e6, 1e7, 1e9}) {
    Plane plane;
    plane.youngs_modulus = youngs;
    const Case c = plane_case(plane, 1e-6);
    ParticleState start = resting(c);
    start.position.z = kRadius - 0.7 * resting_overlap(c);
    Simulation run(c, {&start, 1});
    run.step(20000);
    EXPECT_NEAR((kRadius - run.particle(0).position.z) / resting_overlap(c), 1, 1e-5) << youngs;
  }
}

// Sliding friction turns a sliding sphere until it rolls: at 5/7 of its speed, after 2 u0 / (7 mu g).
TEST_P(Rolling, SlidingSphereRollsAtFiveSevenths) {
  for (const double mu : {0.1, 0.3, 0.6})
    for (const double u0 : {0.1, 0.5}) {
      Plane plane;
      plane.sliding_friction = mu;
      plane.restitution = 0.8;  // a light dashpot: it adds to the sliding friction until the spring is stretched
      const Case c = plane_case(plane, 5e-6);
      const ParticleState start = resting(c, u0);
      Simulation run(c, {&start, 1});
      const double expected_time = 2 * u0 / (7 * mu * kGravity);
      ParticleState p = start;
      while (p.velocity.x > arm(c) * p.spin.y && run.engine().time() < 2 * expected_time)
        run.step(), p = run.particle(0);
      EXPECT_NEAR(run.engine().time() / expected_time, 1, 1e-2) << mu << ", " << u0;
      run.step(20000);
      p = run.particle(0);
      EXPECT_NEAR(p.velocity.x / u0, 5.0 / 7.0, 1e-3) << mu << ", " << u0;
      EXPECT_NEAR(p.velocity.x / (arm(c) * p.spin.y), 1, 1e-4) << mu << ", " << u0;
    }
}

// Without rolling friction it rolls for ever.
TEST_P(Rolling, KeepsRollingWithoutRollingFriction) {
  const Case c = plane_case({});
  const ParticleState start = resting(c, 0.1, 0.1 / arm(c));
  Simulation run(c, {&start, 1});
  run.step(50000);
  EXPECT_NEAR(run.particle(0).velocity.x / 0.1, 1, 1e-5);
}

TEST_P(Rolling, StopsAtTheAnalyticDistance) {
  for (const RollingModel model : {RollingModel::cdt, RollingModel::epsd2})
    for (const double rolling_friction : {0.02, 0.1, 0.3}) {
      Plane plane;
      plane.rolling = model, plane.rolling_friction = rolling_friction;
      const Case c = plane_case(plane);
      const double speed = 0.05;
      const ParticleState start = resting(c, speed, speed / arm(c));
      Simulation run(c, {&start, 1});
      const double resistance = rolling_resistance(c, rolling_friction), limit = 2 * speed / resistance;
      ParticleState p = start;
      while (p.velocity.x > 0 && run.engine().time() < limit) run.step(), p = run.particle(0);
      // EPSD2's spring takes up the torque over the angle M / k_r; the way for half of it comes on top.
      const double kt = 8 * constants_of(c, 0, 0).effective_shear * std::sqrt(kRadius * resting_overlap(c));
      const double spring_way = model == RollingModel::epsd2 ? rolling_friction * mass() * kGravity / kt : 0;
      const double distance = speed * speed / (2 * resistance) + 0.5 * spring_way;
      EXPECT_NEAR(p.position.x / distance, 1, 1e-3) << "model " << static_cast<int>(model) << ", " << rolling_friction;
      EXPECT_NEAR(run.engine().time() / (speed / resistance), 1, 2e-3)
          << "model " << static_cast<int>(model) << ", " << rolling_friction;
    }
}

// At the stop EPSD2's spring holds the limit torque, which is the angle L / R with L = mu_r m g / k_t, and Mindlin's
// spring holds the friction of the deceleration 5/7 mu_r g, which is 5/7 L. Both relax: the sphere rolls back by 12/7
// L.
TEST_P(Rolling, Epsd2RollsBackByItsSpringAfterTheStop) {
  Plane plane;
  plane.rolling = RollingModel::epsd2, plane.rolling_friction = 0.1;
  const Case c = plane_case(plane);
  const ParticleState start = resting(c, 0.02, 0.02 / arm(c));
  Simulation run(c, {&start, 1});
  ParticleState p = start;
  while (p.velocity.x > 0 && run.engine().time() < 1) run.step(), p = run.particle(0);
  const double stop = p.position.x;
  run.step(50000);
  p = run.particle(0);
  const double kt = 8 * constants_of(c, 0, 0).effective_shear * std::sqrt(kRadius * resting_overlap(c));
  const double length = plane.rolling_friction * mass() * kGravity / kt;
  EXPECT_NEAR((stop - p.position.x) / length, 12.0 / 7.0, 2e-3);
  EXPECT_LT(std::abs(p.velocity.x), 1e-6);
}

// tan(slope) against the two frictions decides; EPSD2's limit torque is mu_r |F_n| R.
TEST_P(Rolling, Epsd2HoldsASphereOnAnIncline) {
  for (const double slope_deg : {3.0, 10.0, 20.0, 30.0})
    for (const double mu : {0.1, 0.3, 0.6})
      for (const double mu_r : {0.0, 0.1, 0.3, 0.5}) {
        Plane plane;
        plane.rolling = RollingModel::epsd2, plane.sliding_friction = mu, plane.rolling_friction = mu_r,
        plane.slope_deg = slope_deg;
        const Case c = plane_case(plane, 2e-5);
        const ParticleState start = resting(c);
        Simulation run(c, {&start, 1});
        run.step(5000);
        const ParticleState before = run.particle(0);
        run.step(5000);
        const ParticleState after = run.particle(0);
        const double time = 5000 * c.time.step, a = (after.velocity.x - before.velocity.x) / time;
        const double g = kGravity, tangent = std::tan(degrees(slope_deg)), normal = g * std::cos(degrees(slope_deg));
        // Friction that rolling without slip asks for, over the weight's normal part.
        const double held = std::min(mu_r, tangent);
        const double rolling_friction = (2 * tangent + 5 * held) / 7;
        double expected = 0;
        if (rolling_friction > mu)
          expected = normal * (tangent - mu);
        else if (tangent > mu_r)
          expected = 5.0 / 7.0 * normal * (tangent - mu_r);
        EXPECT_NEAR(a / g, expected / g, 5e-4) << slope_deg << " degrees, mu " << mu << ", mu_r " << mu_r;
        if (expected == 0) {
          EXPECT_LT(std::abs(after.position.x), 0.01 * kRadius)
              << slope_deg << " degrees, mu " << mu << ", mu_r " << mu_r;
        }
      }
}

// The constant torque has no state of rest: below its angle it holds on average, above it the sphere rolls.
TEST_P(Rolling, CdtSlowsARollingSphereOnAnIncline) {
  for (const double mu_r : {0.1, 0.3}) {
    Plane plane;
    plane.rolling = RollingModel::cdt, plane.rolling_friction = mu_r, plane.slope_deg = 20;
    const Case c = plane_case(plane, 2e-5);
    const ParticleState start = resting(c);
    Simulation run(c, {&start, 1});
    run.step(5000);
    const ParticleState before = run.particle(0);
    run.step(5000);
    const double a = (run.particle(0).velocity.x - before.velocity.x) / (5000 * c.time.step);
    const double normal = kGravity * std::cos(degrees(20));
    EXPECT_NEAR(a / kGravity, 5.0 / 7.0 * normal / kGravity * (std::tan(degrees(20)) - mu_r), 5e-4) << mu_r;
  }
}

// Spin about the normal is not rolling: neither model resists it.
TEST_P(Rolling, SpinAboutTheNormalMeetsNoTorque) {
  for (const RollingModel model : {RollingModel::none, RollingModel::cdt, RollingModel::epsd2}) {
    Plane plane;
    plane.rolling = model, plane.rolling_friction = 0.3;
    const Case c = plane_case(plane);
    ParticleState start = resting(c);
    start.spin.z = 32;
    Simulation run(c, {&start, 1});
    run.step(10000);
    EXPECT_EQ(run.particle(0).spin.z, 32) << "model " << static_cast<int>(model);
    EXPECT_EQ(run.particle(0).spin.x, 0);
  }
}

TEST_P(Rolling, SpinAboutTheLineOfCentresMeetsNoTorque) {
  const Vec3 line = unit(Vec3{1, 2, -3});
  for (const RollingModel model : {RollingModel::none, RollingModel::cdt, RollingModel::epsd2}) {
    Plane plane;
    plane.rolling = model, plane.rolling_friction = 0.3;
    Case c = plane_case(plane);
    c.gravity = {0, 0, 0};
    c.solid.primitives.clear();
    const std::vector<ParticleState> pair = {sphere(c, 0, kRadius * line, -0.1 * line, 50.0 * line),
                                             sphere(c, 0, -kRadius * line, 0.1 * line, -30.0 * line)};
    Simulation run(c, pair);
    run.step(2000);
    EXPECT_NEAR(norm(run.particle(0).spin - 50.0 * line), 0, round_off(1e3) * 50)
        << "model " << static_cast<int>(model);
    EXPECT_NEAR(norm(run.particle(1).spin + 30.0 * line), 0, round_off(1e3) * 50)
        << "model " << static_cast<int>(model);
  }
}

}  // namespace
}  // namespace scree
