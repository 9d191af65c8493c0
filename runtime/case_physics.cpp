#include "runtime/case_physics.h"

#include <algorithm>
#include <numbers>
#include <set>

namespace scree {

double rayleigh_time(const Material& m, double radius) {
  const double shear = m.youngs_modulus / (2 * (1 + m.poisson_ratio));
  return std::numbers::pi * radius * std::sqrt(m.density / shear) / (0.1631 * m.poisson_ratio + 0.8766);
}

double hertz_time(const Material& m, double radius, double speed) {
  const double youngs_star = m.youngs_modulus / (2 * (1 - m.poisson_ratio * m.poisson_ratio));
  const double mass = sphere_mass(radius, m.density);
  return 2.87 * std::pow(mass * mass / (0.5 * radius * youngs_star * youngs_star * speed), 0.2);
}

double sphere_mass(double radius, double density) {
  return 4.0 / 3.0 * std::numbers::pi * radius * radius * radius * density;
}

namespace {

double smallest_diameter(const SizeDistribution& d) {
  return d.kind == SizeDistribution::Kind::list ? *std::min_element(d.diameters.begin(), d.diameters.end()) : d.min;
}
double largest_diameter(const SizeDistribution& d) {
  return d.kind == SizeDistribution::Kind::list ? *std::max_element(d.diameters.begin(), d.diameters.end()) : d.max;
}

const MaterialPair* find_pair(const Case& c, uint32_t a, uint32_t b) {
  for (const MaterialPair& p : c.pairs)
    if ((p.first == a && p.second == b) || (p.first == b && p.second == a)) return &p;
  return nullptr;
}

bool same_rows(const auto& table, uint32_t first_column, uint32_t last_column) {
  const auto* reference = table.row(0, first_column);
  for (uint32_t kind = 0; kind < table.kinds; ++kind)
    for (uint32_t column = first_column; column <= last_column; ++column)
      if (!std::equal(reference, reference + 6, table.row(kind, column))) return false;
  return true;
}

}  // namespace

double smallest_radius(const Case& c) {
  double d = 1e300;
  for (const ParticleKind& k : c.kinds) d = std::min(d, smallest_diameter(k.size));
  return 0.5 * d;
}

double largest_radius(const Case& c) {
  double d = 0;
  for (const ParticleKind& k : c.kinds) d = std::max(d, largest_diameter(k.size));
  return 0.5 * d;
}

double smallest_rayleigh_time(const Case& c) {
  double t = 1e300;
  for (const ParticleKind& k : c.kinds)
    t = std::min(t, rayleigh_time(c.materials[k.material], 0.5 * smallest_diameter(k.size)));
  return t;
}

double time_step_of(const Case& c) {
  return c.time.step > 0 ? c.time.step : c.time.rayleigh_fraction * smallest_rayleigh_time(c);
}

template <class Real>
MaterialTable<Real> material_table(const Case& c) {
  MaterialTable<Real> t;
  t.kinds = static_cast<uint32_t>(c.kinds.size());
  // The last column repeats a wall material that occurs, for the kernels that know one row for all walls.
  t.columns = t.kinds + static_cast<uint32_t>(c.materials.size()) + 1;
  t.rows.resize(size_t{t.kinds} * t.columns);
  const auto moduli = [&](uint32_t m) {
    return ElasticModuli{c.materials[m].youngs_modulus, c.materials[m].poisson_ratio};
  };
  const auto fill = [&](uint32_t kind, uint32_t column, uint32_t other) {
    const uint32_t own = c.kinds[kind].material;
    if (const MaterialPair* p = find_pair(c, own, other))
      t.set(kind, column,
            pair_constants(moduli(own), moduli(other), p->restitution, p->sliding_friction, p->rolling_friction));
  };
  std::set<uint32_t> wall_materials;
  for (const Primitive& p : c.solid.primitives) wall_materials.insert(p.material);
  for (uint32_t kind = 0; kind < t.kinds; ++kind) {
    for (uint32_t other = 0; other < t.kinds; ++other) fill(kind, other, c.kinds[other].material);
    for (uint32_t m = 0; m < c.materials.size(); ++m) fill(kind, t.kinds + m, m);
    if (!wall_materials.empty()) fill(kind, t.columns - 1, *wall_materials.begin());
  }
  t.uniform_pairs = same_rows(t, 0, t.kinds - 1);
  t.uniform_walls = true;
  for (uint32_t m : wall_materials) {
    t.uniform_walls &= same_rows(t, t.kinds + m, t.kinds + m);
    t.uniform_walls &= std::equal(t.row(0, t.kinds + m), t.row(0, t.kinds + m) + 6, t.row(0, t.columns - 1));
  }
  return t;
}

template MaterialTable<float> material_table(const Case&);
template MaterialTable<double> material_table(const Case&);

}  // namespace scree
