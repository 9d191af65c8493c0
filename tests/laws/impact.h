// Impacts of two bodies: a sphere on a wall, two spheres. The run ends when they have parted.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/laws/law_test.h"

namespace scree {

// What meets what. `other` is the wall's material or the second sphere's.
struct ImpactBodies {
  Material grain, other;
  double radius = 0;
  double restitution = 1, sliding_friction = 0, rolling_friction = 0;
  RollingModel rolling = RollingModel::none;
};

struct ImpactOutcome {
  ParticleState first, second;  // second: of two spheres
  double duration = 0;          // s, while forces acted
  double largest_force = 0;     // N, on the first
  double largest_overlap = 0;   // m
  bool parted = false;
};

constexpr double kStepsPerContact = 1000;

// Runs until velocities have changed and then stayed as they are for 20 steps.
inline ImpactOutcome run_impact(const Case& c, const std::vector<ParticleState>& bodies, long most_steps = 20000) {
  Simulation run(c, bodies);
  ImpactOutcome result;
  ParticleState before = bodies[0];
  long first_change = -1, last_change = -1;
  for (long k = 0; k < most_steps; ++k) {
    run.step();
    const std::vector<ParticleState> now = run.in_order();
    const Vec3 change = now[0].velocity - before.velocity;
    if (norm(change) > 0) {
      if (first_change < 0) first_change = k;
      last_change = k;
    }
    result.largest_force = std::max(result.largest_force, now[0].mass * norm(change) / c.time.step);
    const double gap = now.size() == 2 ? norm(now[0].position - now[1].position) - now[0].radius - now[1].radius
                                       : now[0].position.z - now[0].radius;
    result.largest_overlap = std::max(result.largest_overlap, -gap);
    before = now[0];
    result.parted = last_change >= 0 && k - last_change > 20;
    if (result.parted || k + 1 == most_steps) {
      result.first = now[0];
      if (now.size() == 2) result.second = now[1];
      result.duration = (last_change - first_change + 1) * c.time.step;
      return result;
    }
  }
  return result;
}

// The step that gives a head-on impact at this speed kStepsPerContact steps.
inline double impact_step(const ImpactBodies& b, bool wall, double speed, double steps_per_contact) {
  const ElasticModuli i{b.grain.youngs_modulus, b.grain.poisson_ratio},
      j{b.other.youngs_modulus, b.other.poisson_ratio};
  const double youngs = pair_constants(i, j, 1, 0, 0).effective_youngs, mass = sphere_mass(b.radius, b.grain.density);
  const HertzImpact hertz{wall ? mass : mass / 2, wall ? b.radius : b.radius / 2, youngs, speed};
  return hertz.contact_time() / steps_per_contact;
}

inline Case impact_case(const ImpactBodies& b, double step, Precision precision) {
  Case c = empty_case(step, precision);
  c.contact.rolling = b.rolling;
  add_material(c, b.grain), add_material(c, b.other);
  c.pairs = {{0, 1, b.restitution, b.sliding_friction, b.rolling_friction}};
  add_kind(c, 0, b.radius);
  return c;
}

// Onto the wall z = 0 from above.
inline ImpactOutcome strike_wall(const ImpactBodies& b, const Vec3& velocity, const Vec3& spin, Precision precision,
                                 double steps_per_contact = kStepsPerContact) {
  const double step = impact_step(b, true, std::abs(velocity.z), steps_per_contact);
  Case c = impact_case(b, step, precision);
  add_solid(c, floor_at(0, 1000 * b.radius, 1));
  return run_impact(c, {sphere(c, 0, {0, 0, b.radius - 0.37 * step * velocity.z}, velocity, spin)});
}

// Two equal spheres along z, the second moving and spinning as `second` says (its position and size are set here).
struct Motion {
  Vec3 velocity{0, 0, 0}, spin{0, 0, 0};
};
inline ImpactOutcome strike_each_other(const ImpactBodies& b, const Motion& first, const Motion& second,
                                       Precision precision, double steps_per_contact = kStepsPerContact) {
  const double closing = second.velocity.z - first.velocity.z;
  const double step = impact_step(b, false, closing, steps_per_contact);
  Case c = impact_case(b, step, precision);
  add_kind(c, 1, b.radius);
  const double half = b.radius + 0.5 * 0.37 * step * closing;
  return run_impact(c, {sphere(c, 0, {0, 0, half}, first.velocity, first.spin),
                        sphere(c, 1, {0, 0, -half}, second.velocity, second.spin)});
}

// The same impact on a wall, written down again from the law (Kaur et al. 2023, Eqs. (1)-(19), as LIGGGHTS 3.8 applies
// them) for motion in a plane, in double, with the semi-implicit Euler scheme and `steps` steps in a contact.
struct PlanarMotion {
  double along, normal, spin;  // m/s, m/s, rad/s; a rolling sphere has along = R spin
};
inline PlanarMotion planar_impact(const ImpactBodies& b, PlanarMotion v, double steps = 20000) {
  const double nu = b.grain.poisson_ratio, mu = b.sliding_friction, e = b.restitution, pi = std::numbers::pi;
  const double youngs = b.grain.youngs_modulus / (1 - nu * nu);
  const double shear = b.grain.youngs_modulus / (2 * (2 - nu) * (1 + nu));
  const double mass = 4.0 / 3.0 * pi * std::pow(b.radius, 3) * b.grain.density;
  const double beta = std::log(e) / std::hypot(std::log(e), pi);
  const double dt = HertzImpact{mass, b.radius, youngs, -v.normal}.contact_time() / steps;
  double overlap = -0.5 * dt * v.normal, spring = 0;
  while (overlap > 0) {
    const double s = std::sqrt(b.radius * overlap), kn = 4.0 / 3.0 * youngs * s, kt = 8 * shear * s;
    const double gn = -2 * std::sqrt(5.0 / 6.0) * beta * std::sqrt(2 * youngs * s * mass);
    const double gt = -2 * std::sqrt(5.0 / 6.0) * beta * std::sqrt(kt * mass);
    const double arm = b.radius - overlap / 2, slip = v.along - arm * v.spin;
    const double push = kn * overlap - gn * v.normal, limit = mu * std::abs(push);
    spring += slip * dt;
    double friction = -kt * spring - gt * slip;
    if (kt * std::abs(spring) > limit) friction = -std::copysign(limit, spring), spring = -friction / kt;
    v.normal += dt * push / mass;
    v.along += dt * friction / mass;
    v.spin -= dt * arm * friction / (0.4 * mass * b.radius * b.radius);
    overlap -= dt * v.normal;
  }
  return v;
}

}  // namespace scree
