// Scenes for the oracle and determinism tests, made by hand: the paper's softened ceramic, loose and settled beds, a
// small lattice. Lengths in m.
#pragma once

#include <algorithm>
#include <memory>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "geometry/closest_point.h"
#include "geometry/octet_lattice.h"
#include "geometry/walls.h"
#include "runtime/case_physics.h"
#include "runtime/engine.h"

namespace scree {

inline constexpr double kDensity = 3071;  // kg/m3
inline constexpr double kStep = 5e-6;     // s, 0.26 of the Rayleigh time of a 400 um sphere
inline constexpr double kRadius = 2e-4;   // m

// Material 0 is the grains', 1 the walls'; one particle kind. No solid, no gravity until a test gives them.
inline Case ceramic_case(const Bounds& domain, const std::set<char>& periodic = {}) {
  Case c;
  c.materials = {{"grain", kDensity, 1e7, 0.28}, {"wall", 0, 1e7, 0.28}};
  c.pairs = {{0, 0, 0.52, 0.53, 0.37}, {0, 1, 0.41, 0.5, 0.41}};
  ParticleKind kind;
  kind.name = "grain";
  kind.size.diameters = {2 * kRadius}, kind.size.fractions = {1};
  c.kinds = {kind};
  c.time.step = kStep;
  c.gravity = {0, 0, 0};
  c.domain = domain;
  for (int a = 0; a < 3; ++a) c.periodic[a] = periodic.contains("xyz"[a]);
  return c;
}

inline ParticleState grain(const Vec3& position, double radius = kRadius, const Vec3& velocity = {0, 0, 0}) {
  ParticleState p;
  p.radius = static_cast<double>(static_cast<float>(radius));  // the same number in both precisions
  p.position = position, p.velocity = velocity, p.spin = {0, 0, 0}, p.mass = sphere_mass(p.radius, kDensity);
  return p;
}

class Random {
 public:
  explicit Random(uint32_t seed) : engine_(seed) {}
  double between(double low, double high) { return low + (high - low) * (engine_() / 4294967296.0); }
  Vec3 in(const Bounds& b) {
    const double x = between(b.min.x, b.max.x), y = between(b.min.y, b.max.y), z = between(b.min.z, b.max.z);
    return {x, y, z};
  }
  uint32_t below(uint32_t n) { return static_cast<uint32_t>(engine_() % n); }

 private:
  std::mt19937 engine_;
};

// `n` layers of spheres on a cubic grid with room for the largest, moved at random inside their cells.
struct LooseBed {
  int nx, ny, nz;
  double smallest = kRadius, largest = kRadius;  // radii, evenly distributed between
  double spacing = 2.1;  // of the grid, in largest radii; near 2 columns stand on each other and stay
  double pitch() const { return spacing * largest; }
  std::vector<ParticleState> particles(const Vec3& origin, uint32_t seed) const {
    Random random(seed);
    std::vector<ParticleState> result;
    for (int z = 0; z < nz; ++z)
      for (int y = 0; y < ny; ++y)
        for (int x = 0; x < nx; ++x) {
          const double radius = random.between(smallest, largest), room = 0.49 * pitch() - radius;
          const Vec3 middle = origin + pitch() * Vec3{x + 0.5, y + 0.5, z + 0.5};
          result.push_back(grain(middle + random.in({{-room, -room, -room}, {room, room, room}}), radius));
        }
    return result;
  }
};

// A box with a floor at z = 0 under a loose bed, gravity, periodic sideways.
inline Case bed_case(const LooseBed& bed) {
  const double p = bed.pitch();
  Case c = ceramic_case({{0, 0, -bed.largest}, {bed.nx * p, bed.ny * p, (bed.nz + 1) * p}}, {'x', 'y'});
  c.gravity = {0, 0, -9.81};
  c.solid.walls = {"floor"};
  // As long as the box: periodic images continue it.
  c.solid.primitives = rectangle({0, 0, 0}, {bed.nx * p, 0, 0}, {0, bed.ny * p, 0}, {1, 0});
  return c;
}

inline EngineOptions with_skin(double skin) {
  EngineOptions options;
  options.skin = skin;
  return options;
}

inline void run_steps(Engine& engine, int steps) {
  for (int k = 0; k < steps; ++k) engine.step();
}

inline std::vector<ParticleState> by_id(const Engine& engine) {
  std::vector<ParticleState> all = engine.particles();
  std::ranges::sort(all, {}, &ParticleState::id);
  return all;
}

// The periods of a case's axes, 0 where not periodic.
inline Vec3 periods(const Case& c) {
  const Vec3 length = c.domain.max - c.domain.min;
  return {c.periodic[0] ? length.x : 0, c.periodic[1] ? length.y : 0, c.periodic[2] ? length.z : 0};
}

// A small lattice, one cell wide, with a channel round it, a hopper above, and a lid at its top (z = 0). Walls, in
// order: lattice, channel, hopper, lid.
inline void add_small_lattice(Case& c) {
  const auto add = [&](const Primitives& p) {
    c.solid.primitives.insert(c.solid.primitives.end(), p.begin(), p.end());
  };
  c.solid.walls = {"lattice", "channel", "hopper", "lid"};
  add(fibre_primitives(octet_lattice(0.005, {1, 1, 2}, {-0.0025, -0.0025, -0.01}), 4e-4, {1, 0}));
  add(channel({{-0.0025, -0.0025, -0.01}, {0.0025, 0.0025, 0}}, {1, 1}));
  add(frustum({0, 0, 0, 0.005, 0.005, 0.008, 0.008, 0.008}, {1, 2}));
  add(channel({{-0.004, -0.004, 0.008}, {0.004, 0.004, 0.02}}, {1, 2}));
  add(rectangle({-0.0025, -0.0025, 0}, {0.005, 0, 0}, {0, 0.005, 0}, {1, 3}));
}

}  // namespace scree
