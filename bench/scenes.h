// The scenes that the benchmarks time. A settled bed is made once, small and periodic, and tiled to any size: every
// tile is the same settled state, so a million particles need no hours of settling.
#pragma once

#include "geometry/walls.h"
#include "runtime/case_physics.h"
#include "runtime/placement.h"

namespace scree::bench {

inline constexpr double kDiameter = 4e-4;  // m, the paper's particles

// The paper's materials and contact law (Kaur et al. 2023, Table 2), without particles or walls.
inline Case paper_case() {
  Case c;
  c.materials = {{"carbobead", 3071, 1e7, 0.28}, {"steel", 0, 1e7, 0.28}};
  c.pairs = {{0, 0, 0.52, 0.53, 0.37}, {0, 1, 0.41, 0.5, 0.41}};
  ParticleKind grain;
  grain.name = "grain";
  grain.size.diameters = {kDiameter}, grain.size.fractions = {1};
  c.kinds = {grain};
  c.time.step = 5e-6;
  return c;
}

// A bed on a floor, periodic in x and y: `tiles` x `tiles` copies of one of 25 x 25 diameters and ~10,000 particles.
inline Case bed_case(int tiles) {
  Case c = paper_case();
  const double side = 25 * kDiameter * tiles, height = 60 * kDiameter;
  c.domain = {{0, 0, -kDiameter}, {side, side, height}};
  c.periodic[0] = c.periodic[1] = true;
  c.solid.walls = {"floor"};
  c.solid.primitives = rectangle({0, 0, 0}, {side, 0, 0}, {0, side, 0}, {1, 0});
  return c;
}

// One tile at rest. Settled by the engine itself from a random packing; kept for the process' life.
inline const std::vector<ParticleState>& settled_tile() {
  static const std::vector<ParticleState> tile = [] {
    const Case c = bed_case(1);
    Case filled = c;
    Region box;
    box.name = "bed";
    const double side = 25 * kDiameter;
    box.min = {0, 0, 0}, box.max = {side, side, 16 * kDiameter};
    filled.regions = {box};
    FillStage stage;
    stage.regions = {0}, stage.mixture = {{0}, {1.0}}, stage.solid_fraction = 0.55;
    auto engine = make_engine(c);
    engine->insert(fill(filled, stage, c.solid, {}, 1));
    for (int k = 0; k < 40000; ++k) engine->step();
    return engine->particles();
  }();
  return tile;
}

inline std::vector<ParticleState> settled_bed(int tiles) {
  std::vector<ParticleState> bed;
  const double side = 25 * kDiameter;
  for (int y = 0; y < tiles; ++y)
    for (int x = 0; x < tiles; ++x)
      for (ParticleState p : settled_tile()) {
        p.position += {x * side, y * side, 0};
        bed.push_back(p);
      }
  return bed;
}

}  // namespace scree::bench
