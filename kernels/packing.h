// A dense random packing without overlaps: spheres dropped at random are pushed apart until none overlaps.
// Positions in m. Deterministic for every number of threads.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "geometry/vec.h"

namespace scree {

struct PackedSphere {
  Vec3 position;
  double radius;
};

// Moves a sphere's centre to where it is allowed: inside a region, clear of walls and fibres. Called from several
// threads.
using Confine = std::function<Vec3(const Vec3& position, double radius)>;

struct PackingOutcome {
  int iterations = 0;
  double worst_overlap = 0;  // share of the smaller radius, between any two, before the last iteration's moves
  bool confined = true;      // every sphere is where confine() leaves it
};

// Pushes `spheres` apart; `fixed` ones do not move. Ends when nothing overlaps or after `max_iterations`. At solid
// fractions up to about 0.6 this converges; the denser, the longer. `look` is called before each sweep, with what came
// of those before it, and may throw to give up.
PackingOutcome push_apart(
    std::span<PackedSphere> spheres, std::span<const PackedSphere> fixed, const Confine& confine, int max_iterations,
    const std::function<void(const PackingOutcome&)>& look = [](const PackingOutcome&) {});

}  // namespace scree
