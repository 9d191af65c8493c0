// Which primitives of a solid are near a point: the search that particle-wall and particle-fibre candidates come from.
// Two implementations that answer alike, bit for bit: Embree's bounding volume hierarchy, and its slow, obvious twin,
// which is its oracle. Neither can change after it is made: for another solid (a wall removed) make another index.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "geometry/solid.h"

namespace scree {

class SolidIndex {
 public:
  virtual ~SolidIndex() = default;

  // Appends to `found`, ascending, the index in Solid::primitives of each primitive whose surface is within `reach` of
  // x: distance(primitive, x) <= reach, m. Inside a rounded primitive the distance is negative. Thread-safe.
  virtual void query(const Vec3& x, double reach, std::vector<uint32_t>& found) const = 0;
};

// Both copy what they need of the solid. Throw std::invalid_argument for a primitive that prepared() refuses, and with
// Embree for one beyond 1e15 m; std::runtime_error if Embree fails.
std::unique_ptr<SolidIndex> make_embree_index(const Solid& solid);
std::unique_ptr<SolidIndex> make_brute_force_index(const Solid& solid);

}  // namespace scree
