// Head-on impacts: restitution, the constants of each pair of materials, Hertz's overlap and contact time.
//
// With the dashpot of this law the equation of the overlap becomes that of a linear oscillator for overlap^(5/4)
// (Antypov & Elliott 2011, EPL 94:50004), so the restitution is e exactly; what is left is the error of the time step,
// of first order as the dashpot sees velocities half a step old.
#include "tests/laws/impact.h"

namespace scree {
namespace {

class Restitution : public LawTest {};
SCREE_IN_BOTH_PRECISIONS(Restitution);

const Material kGrain{"grain", 2500, 1e7, 0.3};
const Material kWall{"wall", 0, 5e7, 0.2};
constexpr double kRadius = 0.002, kSpeed = 0.5;

double rebound_from_wall(double e, Precision precision, double steps = kStepsPerContact) {
  const ImpactOutcome out = strike_wall({kGrain, kWall, kRadius, e, 0.3}, {0, 0, -kSpeed}, {0, 0, 0}, precision, steps);
  return out.first.velocity.z / kSpeed;
}

TEST_P(Restitution, SphereOnWall) {
  for (const double e : {0.1, 0.3, 0.5, 0.7, 0.9, 1.0}) EXPECT_NEAR(rebound_from_wall(e, GetParam()), e, 5e-4) << e;
}

TEST_P(Restitution, TwoSpheres) {
  for (const double e : {0.1, 0.3, 0.5, 0.7, 0.9, 1.0}) {
    const ImpactOutcome out =
        strike_each_other({kGrain, kGrain, kRadius, e, 0.3}, {{0, 0, -kSpeed}}, {{0, 0, kSpeed}}, GetParam());
    EXPECT_NEAR(out.first.velocity.z / kSpeed, e, 5e-4) << e;
    EXPECT_EQ(out.second.velocity.z, -out.first.velocity.z);
  }
}

// Onto the side of a fibre along x, and onto its round end.
TEST_P(Restitution, SphereOnFibre) {
  const double thickness = 0.001;
  for (const double e : {0.1, 0.3, 0.5, 0.7, 0.9, 1.0})
    for (const double end : {0.01, 0.0}) {
      const ImpactBodies bodies{kGrain, kWall, kRadius, e, 0.3};
      const double step = impact_step(bodies, true, kSpeed, kStepsPerContact);
      Case c = impact_case(bodies, step, GetParam());
      const Segment axis{{-0.01, 0, -0.5 * thickness}, {end, 0, -0.5 * thickness}};
      add_solid(c, fibre_network({&axis, 1}, thickness, {1, 0}));
      const ImpactOutcome out = run_impact(c, {sphere(c, 0, {0, 0, kRadius + 0.37 * step * kSpeed}, {0, 0, -kSpeed})});
      EXPECT_NEAR(out.first.velocity.z / kSpeed, e, 5e-4) << e << ", fibre ends at " << end;
      EXPECT_NEAR(out.first.velocity.x, 0, 1e-6 * kSpeed);
    }
}

TEST_P(Restitution, ErrorShrinksWithTheTimeStep) {
  const double steps[] = {25, 50, 100, 400, 1600};
  const double bounds[] = {2e-2, 1e-2, 3e-3, 7e-4, 2e-4};
  for (int k = 0; k < 5; ++k)
    for (const double e : {0.3, 0.5, 0.7, 0.9, 1.0})
      EXPECT_NEAR(rebound_from_wall(e, GetParam(), steps[k]), e, bounds[k]) << e << ", " << steps[k] << " steps";
}

// e = 0 is the critically damped limit: the sphere stays in contact and creeps out.
TEST_P(Restitution, NoReboundForZero) { EXPECT_NEAR(rebound_from_wall(0, GetParam()), 0, 2e-3); }

// Three kinds and two wall materials in one run, every pair with its own restitution, far from one another.
TEST_P(Restitution, EveryPairOfMaterialsHasItsOwn) {
  const double particles[3][3] = {{0.9, 0.8, 0.7}, {0.8, 0.6, 0.5}, {0.7, 0.5, 0.3}};
  const double walls[3][2] = {{0.95, 0.2}, {0.4, 0.85}, {0.65, 0.75}};
  const Material materials[5] = {{"a", 2500, 1e7, 0.3},
                                 {"b", 1200, 3e7, 0.2},
                                 {"c", 4000, 6e6, 0.4},
                                 {"wall 1", 0, 1e8, 0.3},
                                 {"wall 2", 0, 5e6, 0.1}};
  const double radii[3] = {0.002, 0.001, 0.003};
  Case c = empty_case(1e-7, GetParam());
  for (const Material& m : materials) add_material(c, m);
  for (uint32_t i = 0; i < 3; ++i) {
    add_kind(c, i, radii[i]);
    for (uint32_t j = i; j < 3; ++j) c.pairs.push_back({i, j, particles[i][j], 0.2, 0});
    for (uint32_t w = 0; w < 2; ++w) c.pairs.push_back({i, 3 + w, walls[i][w], 0.2, 0});
  }
  std::vector<ParticleState> bodies;
  const double apart = 0.1, gap = 1e-6;
  for (uint32_t i = 0; i < 3; ++i)
    for (uint32_t j = 0; j < 3; ++j) {
      const double reach = radii[i] + radii[j] + gap;
      const Vec3 at{apart * (1 + i), apart * (1 + j), 0.5};
      bodies.push_back(sphere(c, i, at, {kSpeed, 0, 0}));
      bodies.push_back(sphere(c, j, at + Vec3{reach, 0, 0}, {-kSpeed, 0, 0}));
    }
  for (uint32_t i = 0; i < 3; ++i)
    for (uint32_t w = 0; w < 2; ++w) {
      const double x = apart * (1 + i), y = -apart * (1 + w);
      add_solid(c, rectangle({x - 0.02, y - 0.02, 0}, {0.04, 0, 0}, {0, 0.04, 0}, {3 + w, 0}));
      bodies.push_back(sphere(c, i, {x, y, radii[i] + gap}, {0, 0, -kSpeed}));
    }
  Simulation run(c, bodies);
  run.step(30000);
  const std::vector<ParticleState> after = run.in_order();
  for (uint32_t i = 0; i < 3; ++i)
    for (uint32_t j = 0; j < 3; ++j) {
      const size_t k = 2 * (3 * i + j);
      EXPECT_NEAR((after[k + 1].velocity.x - after[k].velocity.x) / (2 * kSpeed), particles[i][j], 5e-4)
          << i << " on " << j;
    }
  for (uint32_t i = 0; i < 3; ++i)
    for (uint32_t w = 0; w < 2; ++w)
      EXPECT_NEAR(after[18 + 2 * i + w].velocity.z / kSpeed, walls[i][w], 5e-4) << i << " on wall " << w;
}

// Unequal spheres of unequal materials, along an oblique line of centres.
TEST_P(Restitution, UnequalSpheresMeetHertzOverlapAndContactTime) {
  const Material small{"small", 4000, 2e7, 0.2}, large{"large", 2500, 1e7, 0.35};
  const Vec3 line = unit(Vec3{1, -2, 0.7});
  for (const double ratio : {1.0, 3.0, 10.0}) {
    const double r1 = 0.001, r2 = ratio * r1;
    const double m1 = sphere_mass(r1, small.density), m2 = sphere_mass(r2, large.density);
    const double youngs = 1 / ((1 - 0.04) / 2e7 + (1 - 0.1225) / 1e7);
    const HertzImpact hertz{m1 * m2 / (m1 + m2), r1 * r2 / (r1 + r2), youngs, 2 * kSpeed};
    Case c = empty_case(hertz.contact_time() / kStepsPerContact, GetParam());
    add_material(c, small), add_material(c, large);
    c.pairs = {{0, 1, 1, 0.3, 0}};
    add_kind(c, 0, r1), add_kind(c, 1, r2);
    const double reach = r1 + r2 + 0.37 * c.time.step * 2 * kSpeed;
    const ImpactOutcome out =
        run_impact(c, {sphere(c, 0, reach * line, -kSpeed * line), sphere(c, 1, {0, 0, 0}, kSpeed * line)});
    EXPECT_NEAR(out.largest_overlap / hertz.largest_overlap(), 1, 1e-5) << ratio;
    EXPECT_NEAR(out.largest_force / hertz.largest_force(), 1, 1e-5) << ratio;
    EXPECT_NEAR(out.duration / hertz.contact_time(), 1, 2 / kStepsPerContact) << ratio;
    EXPECT_NEAR(dot(out.first.velocity, line) / kSpeed, (3 * m2 - m1) / (m1 + m2), 1e-5) << ratio;
  }
}

}  // namespace
}  // namespace scree
