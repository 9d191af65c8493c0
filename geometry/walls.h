// Generators of walls and fibres as primitives of a solid. All lengths in m, z up. A wall has no thickness and two
// sides. An argument out of range throws std::invalid_argument with its name, value, allowed range and unit.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "geometry/solid.h"

namespace scree {

using Primitives = std::vector<Primitive>;

// Four corners in order, anywhere in space. They must be planar (to 1e-6 of the size) and convex; a triangle repeats
// its last corner.
Primitives quad(const std::array<Vec3, 4>& corners, const SurfaceLabel& label);

// The rectangle with one corner at `corner` and two edges, which must be at a right angle.
Primitives rectangle(const Vec3& corner, const Vec3& edge, const Vec3& other_edge, const SurfaceLabel& label);

// The infinite plane as far as it matters: a rectangle that covers all of the plane inside the domain, and no more than
// that if the normal is perpendicular to a coordinate axis. The normal need not be of unit length.
Primitives plane(const Vec3& point, const Vec3& normal, const Bounds& domain, const SurfaceLabel& label);

struct BoxFaces {
  bool x_min = true, x_max = true, y_min = true, y_max = true, z_min = true, z_max = true;
};
Primitives box_walls(const Bounds& box, const BoxFaces& faces, const SurfaceLabel& label);

// The four upright faces of a box.
Primitives channel(const Bounds& box, const SurfaceLabel& label);

// A hopper of rectangular section, open below and above; four trapezoids.
//
//     \         /  z1   top_x x top_y
//      \       /
//       +-----+    z0   bottom_x x bottom_y, both centred on (centre_x, centre_y)
struct Frustum {
  double centre_x = 0, centre_y = 0;
  double z0 = 0, bottom_x = 0, bottom_y = 0;
  double z1 = 0, top_x = 0, top_y = 0;
};
Primitives frustum(const Frustum& shape, const SurfaceLabel& label);

// Surfaces of revolution. `axis` points from base or centre along the height; it need not be of unit length.
Primitives cylinder(const Vec3& base, const Vec3& axis, double radius, double height, const SurfaceLabel& label);
struct Cone {
  Vec3 base{}, axis{0, 0, 1};
  double base_radius = 0, top_radius = 0, height = 0;
};
Primitives cone(const Cone& shape, const SurfaceLabel& label);
Primitives disc(const Vec3& centre, const Vec3& axis, double radius, const SurfaceLabel& label);
// A plate with a round hole.
Primitives annulus(const Vec3& centre, const Vec3& axis, double inner_radius, double outer_radius,
                   const SurfaceLabel& label);

// One capsule for each centre line.
Primitives fibre_network(std::span<const Segment> axes, double diameter, const SurfaceLabel& label);

}  // namespace scree
