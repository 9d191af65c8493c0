#include "runtime/contact_sums.h"

#include <numbers>

namespace scree {

namespace {

// m += v (x) w
void add_product(std::array<double, 9>& m, const Vec3& v, const Vec3& w) {
  const double a[] = {v.x, v.y, v.z}, b[] = {w.x, w.y, w.z};
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) m[3 * r + c] += a[r] * b[c];
}

}  // namespace

ContactSums contact_sums(std::span<const ParticleState> particles, std::span<const ContactState> contacts) {
  const size_t n = particles.size();
  ContactSums sums{std::vector<Vec3>(n, Vec3{0, 0, 0}), std::vector<uint16_t>(n), std::vector<uint16_t>(n),
                   std::vector<std::array<double, 9>>(n)};
  for (const ContactState& k : contacts) {
    sums.force[k.i] += k.force;
    add_product(sums.stress[k.i], k.point - particles[k.i].position, k.force);
    if (k.with_solid) {
      ++sums.wall_contacts[k.i];
      continue;
    }
    // From j the point lies along the normal; its own coordinates may be those of i's periodic image.
    ++sums.coordination[k.i], ++sums.coordination[k.j];
    sums.force[k.j] -= k.force;
    add_product(sums.stress[k.j], (particles[k.j].radius - 0.5 * k.overlap) * k.normal, -k.force);
  }
  for (size_t i = 0; i < n; ++i) {
    const double r = particles[i].radius, scale = -3 / (4 * std::numbers::pi * r * r * r);
    for (double& s : sums.stress[i]) s *= scale;
  }
  return sums;
}

}  // namespace scree
