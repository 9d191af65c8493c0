#include "runtime/contact_sums.h"

#include <numbers>

#include "kernels/parallel.h"

namespace scree {

namespace {

using Stress = std::array<float, 6>;

// s -= sym(v (x) w)
void subtract_product(Stress& s, const Vec3& v, const Vec3& w) {
  const double sum[] = {v.x * w.x,
                        v.y * w.y,
                        v.z * w.z,
                        0.5 * (v.x * w.y + v.y * w.x),
                        0.5 * (v.y * w.z + v.z * w.y),
                        0.5 * (v.x * w.z + v.z * w.x)};
  for (int k = 0; k < 6; ++k) s[k] -= static_cast<float>(sum[k]);
}

double inverse_volume(double radius) { return 3 / (4 * std::numbers::pi * radius * radius * radius); }

}  // namespace

ContactSums contact_sums(const Engine& engine) {
  if (!engine.knows_contacts()) return {};
  const size_t n = engine.count();
  std::vector<double> radii(n);
  parallel_for_each(n, [&](size_t k) { radii[k] = engine.particle(k).radius; });
  ContactSums sums{std::vector<Vec3>(n, Vec3{0, 0, 0}), std::vector<uint16_t>(n), std::vector<uint16_t>(n),
                   std::vector<Stress>(n)};
  // From a particle the point lies along the normal, whatever its coordinates: a periodic pair's are those beside i.
  const auto add = [&](size_t k, double inside, const Vec3& towards, const Vec3& force) {
    sums.force[k] += force;
    subtract_product(sums.stress[k], (radii[k] - inside) * towards, force);
  };
  engine.visit_contacts_by_particles([&](size_t first, size_t last, const ContactState& k) {
    const double inside = k.with_solid ? k.overlap : 0.5 * k.overlap;  // how deep the point lies
    add(k.i, inside, -k.normal, k.force);
    ++(k.with_solid ? sums.wall_contacts : sums.coordination)[k.i];
    if (k.with_solid || k.j < first || k.j >= last) return;
    add(k.j, inside, k.normal, -k.force);
    ++sums.coordination[k.j];
  });
  parallel_for_each(n, [&](size_t k) {
    for (float& s : sums.stress[k]) s *= static_cast<float>(inverse_volume(radii[k]));
  });
  return sums;
}

}  // namespace scree
