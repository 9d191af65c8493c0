// Scenes filled in by hand: cases as values and the engine that runs them. For tests and benchmarks. SI units.
#pragma once

#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "geometry/walls.h"
#include "runtime/case_physics.h"
#include "runtime/engine.h"

namespace scree {

// Nothing in it: no particles, no solid, no gravity. The domain reaches 10 m from the origin.
inline Case empty_case(double time_step, Precision precision = Precision::mixed) {
  Case c;
  c.gravity = {0, 0, 0};
  c.domain = {{-10, -10, -10}, {10, 10, 10}};
  c.time.step = time_step;
  c.contact.precision = precision;
  c.contact.rolling = RollingModel::none;
  c.solid.walls = {"wall"};
  return c;
}

// Each returns the index of what it adds.
inline uint32_t add_material(Case& c, const Material& material) {
  c.materials.push_back(material);
  return static_cast<uint32_t>(c.materials.size() - 1);
}
inline uint32_t add_kind(Case& c, uint32_t material, double radius) {
  ParticleKind kind;
  kind.name = "kind " + std::to_string(c.kinds.size());
  kind.material = material;
  kind.size.diameters = {2 * radius};
  kind.size.fractions = {1};
  c.kinds.push_back(kind);
  return static_cast<uint32_t>(c.kinds.size() - 1);
}

inline void add_solid(Case& c, const Primitives& primitives) {
  c.solid.primitives.insert(c.solid.primitives.end(), primitives.begin(), primitives.end());
}

// A square floor at the height z, centred on the z axis, facing both ways.
inline Primitives floor_at(double z, double side, uint32_t material) {
  return rectangle({-0.5 * side, -0.5 * side, z}, {side, 0, 0}, {0, side, 0}, {material, 0});
}

inline double radius_of(const Case& c, uint32_t kind) { return 0.5 * c.kinds[kind].size.diameters[0]; }

// A sphere of the kind's first diameter.
inline ParticleState sphere(const Case& c, uint32_t kind, const Vec3& position, const Vec3& velocity = {0, 0, 0},
                            const Vec3& spin = {0, 0, 0}) {
  const double radius = radius_of(c, kind);
  const double density = c.materials[c.kinds[kind].material].density;
  return {position, velocity, spin, radius, sphere_mass(radius, density), kind, 0};
}

inline PairConstants<double> constants_of(const Case& c, uint32_t material_i, uint32_t material_j) {
  const auto moduli = [&](uint32_t m) {
    return ElasticModuli{c.materials[m].youngs_modulus, c.materials[m].poisson_ratio};
  };
  for (const MaterialPair& p : c.pairs)
    if ((p.first == material_i && p.second == material_j) || (p.first == material_j && p.second == material_i))
      return pair_constants(moduli(material_i), moduli(material_j), p.restitution, p.sliding_friction,
                            p.rolling_friction);
  throw std::invalid_argument("no such pair of materials in the case");
}

// A case under way. Ids follow the order of `particles`.
class Simulation {
 public:
  Simulation(const Case& c, std::span<const ParticleState> particles, const EngineOptions& options = {})
      : engine_(make_engine(c, options)) {
    engine_->insert(particles);
  }

  Engine& engine() { return *engine_; }
  void step(long count = 1) {
    for (long k = 0; k < count; ++k) engine_->step();
  }
  std::vector<ParticleState> in_order() const {  // by id
    const std::vector<ParticleState> stored = engine_->particles();
    std::vector<ParticleState> ordered(stored.size());
    for (const ParticleState& p : stored) ordered.at(p.id) = p;
    return ordered;
  }
  ParticleState particle(uint64_t id) const { return in_order().at(id); }

 private:
  std::unique_ptr<Engine> engine_;
};

}  // namespace scree
