// The scheme is exact for a constant force: leapfrog with a first kick of half a step puts positions on the parabola
// and velocities half a step behind them.
#include "tests/laws/law_test.h"

namespace scree {
namespace {

class FreeFall : public LawTest {};
SCREE_IN_BOTH_PRECISIONS(FreeFall);

// Each step rounds the velocity; it does so the same way for many steps, so the roundings add up.
TEST_P(FreeFall, FollowsTheParabola) {
  Case c = empty_case(1e-4, GetParam());
  add_material(c, {"grain", 2500, 1e7, 0.3});
  c.pairs = {{0, 0, 0.5, 0.5, 0}};
  add_kind(c, 0, 0.002);
  c.gravity = {0.3, -1.1, -9.81};
  const Vec3 x0{0.1, 0.2, 0.3}, v0{0.5, -0.25, 1};
  const ParticleState start = sphere(c, 0, x0, v0, {1, 2, 3});
  Simulation run(c, {&start, 1});
  for (int n = 1; n <= 1000; ++n) {
    run.step();
    const ParticleState p = run.particle(0);
    const double t = n * 1e-4, half = (n - 0.5) * 1e-4;
    const Vec3 x = x0 + t * v0 + (0.5 * t * t) * c.gravity, v = v0 + half * c.gravity;
    ASSERT_LT(norm(p.position - x), 1e-15 + round_off(400) * t) << n;
    ASSERT_LT(norm(p.velocity - v), round_off(400)) << n;
    ASSERT_EQ(p.spin.z, 3);
  }
}

}  // namespace
}  // namespace scree
