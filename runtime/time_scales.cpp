#include "runtime/time_scales.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "runtime/case_physics.h"

namespace scree {

TimeScales time_scales(const Case& c) {
  const Vec3 size = c.domain.max - c.domain.min;
  const double fall = std::abs(c.gravity.x) * size.x + std::abs(c.gravity.y) * size.y + std::abs(c.gravity.z) * size.z;
  TimeScales s{time_step_of(c), smallest_rayleigh_time(c), 1e300, std::max(0.1, std::sqrt(2 * fall))};
  for (const ParticleKind& k : c.kinds)
    s.hertz = std::min(s.hertz, hertz_time(c.materials[k.material], smallest_radius(c), s.speed));
  return s;
}

std::vector<std::string> time_step_warnings(const Case& c) {
  const TimeScales s = time_scales(c);
  const double share = s.step / s.rayleigh;
  if (share <= 0.3) return {};
  return {fmt::format(
      "the time step {:.4g} s is {:.2f} of the smallest Rayleigh time {:.4g} s; above 0.3 contacts are badly resolved",
      s.step, share, s.rayleigh)};
}

}  // namespace scree
