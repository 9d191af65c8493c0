// A solid that particles touch: a union of rounded primitives. Each primitive is a skeleton (a segment, a planar quad
// or a line of revolution) and a radius; its surface is every point at that distance from the skeleton.
// A fibre is a segment with a radius (a capsule); walls are quads and surfaces of revolution of radius 0.
// Lengths in m.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "geometry/vec.h"

namespace scree {

// Points a + t (b - a), 0 <= t <= 1.
struct Segment {
  Vec3 a, b;
};

// A planar convex quadrilateral, corners in order; a triangle repeats its last corner.
struct Quad {
  Vec3 corners[4];
};

// The line from (r0, h0) to (r1, h1) in the (distance from axis, height along axis) half-plane, turned round the axis
// through `base` along the unit vector `axis`: a cylinder (r0 = r1), a cone, a disc (h0 = h1, r0 = 0), an annulus.
struct Revolution {
  Vec3 base, axis;
  double r0, h0, r1, h1;
};

struct Primitive {
  std::variant<Segment, Quad, Revolution> skeleton;
  double radius = 0;       // m, the rounding radius: a fibre's radius, 0 for walls
  uint32_t material = 0;   // index into the case's materials
  uint32_t wall = 0;       // index into Solid::walls: what a stage can remove and a meter can name
  Vec3 velocity{0, 0, 0};  // m/s, translation of the surface
};

// What a generator writes on every primitive it makes.
struct SurfaceLabel {
  uint32_t material = 0;  // Primitive::material
  uint32_t wall = 0;      // Primitive::wall
};

struct Solid {
  std::vector<std::string> walls;  // names; walls[p.wall] is the part a primitive belongs to
  std::vector<Primitive> primitives;
};

struct Bounds {
  Vec3 min, max;
};

}  // namespace scree
