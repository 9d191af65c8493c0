#include "runtime/contact_sums.h"

#include <algorithm>
#include <numbers>
#include <vector>

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

Array<ContactSum> contact_sums(const Engine& engine) {
  Array<ContactSum> sums;
  if (!engine.knows_contacts()) return sums;
  sums.allocate(engine.count());
  engine.visit_contacts_by_particles([&](size_t first, size_t last, const Engine::EachContact& each) {
    std::fill_n(sums.data() + first, last - first, ContactSum{});
    std::vector<double> radii;
    radii.reserve(last - first);
    for (size_t k = first; k < last; ++k) radii.push_back(engine.particle(k).radius);
    // The point lies along the normal, whatever its coordinates: a periodic pair's are those beside i. `inside`: how
    // deep it lies.
    const auto add = [&](size_t k, double inside, const Vec3& towards, const Vec3& force) -> ContactSum& {
      sums[k].force += force;
      subtract_product(sums[k].stress, (radii[k - first] - inside) * towards, force);
      return sums[k];
    };
    each([&](const ContactState& k) {
      if (k.with_solid) {
        ++add(k.i, k.overlap, -k.normal, k.force).wall_contacts;
        return;
      }
      ++add(k.i, 0.5 * k.overlap, -k.normal, k.force).coordination;
      if (k.j >= first && k.j < last) ++add(k.j, 0.5 * k.overlap, k.normal, -k.force).coordination;
    });
    for (size_t k = first; k < last; ++k)
      for (float& s : sums[k].stress) s *= static_cast<float>(inverse_volume(radii[k - first]));
  });
  return sums;
}

}  // namespace scree
