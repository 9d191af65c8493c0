// Random values for the tests of geometry; every test seeds its own, so that it repeats.
#pragma once

#include <cstdint>
#include <random>

#include "geometry/closest_point.h"

namespace scree {

class RandomGeometry {
 public:
  explicit RandomGeometry(uint32_t seed) : engine_(seed) {}

  double between(double low, double high) { return low + (high - low) * (engine_() / 4294967296.0); }
  Vec3 in_box(const Bounds& b) {
    const double x = between(b.min.x, b.max.x), y = between(b.min.y, b.max.y), z = between(b.min.z, b.max.z);
    return {x, y, z};
  }
  Vec3 in_cube(double half) { return in_box({{-half, -half, -half}, {half, half, half}}); }
  Vec3 direction() {
    for (;;) {
      const Vec3 v = in_cube(1);
      if (norm(v) > 0.1 && norm(v) < 1) return unit(v);
    }
  }

  Segment segment() {
    const Vec3 a = in_cube(1);
    return {a, in_cube(1)};
  }
  // Four corners at rising angles on an ellipse in a random plane: convex, planar.
  Quad quad() {
    const Vec3 centre = in_cube(1), normal = direction(), u = perpendicular_to(normal), v = cross(normal, u);
    const double wide = between(0.2, 1), high = between(0.2, 1);
    Quad quad{};
    for (int k = 0; k < 4; ++k) {
      const double angle = 1.5 * k + between(0.1, 1.4);
      quad.corners[k] = centre + wide * std::cos(angle) * u + high * std::sin(angle) * v;
    }
    return quad;
  }
  Quad triangle() {
    Quad triangle = quad();
    triangle.corners[3] = triangle.corners[2];
    return triangle;
  }
  Revolution revolution() {
    const Vec3 base = in_cube(1), axis = direction();
    const double r0 = between(0, 1), h0 = between(-1, 1), r1 = between(0, 1), h1 = between(-1, 1);
    return {base, axis, r0, h0, r1, h1};
  }

 private:
  std::mt19937 engine_;
};

// Points of a skeleton for parameters s, t in [0, 1], written without the code under test.
inline Vec3 point_of(const Segment& g, double s, double) { return (1 - s) * g.a + s * g.b; }
inline Vec3 point_of(const Quad& g, double s, double t) {
  if (norm(g.corners[3] - g.corners[2]) == 0) {  // a triangle: the unit square folded along its diagonal
    if (s + t > 1) s = 1 - s, t = 1 - t;
    return g.corners[0] + s * (g.corners[1] - g.corners[0]) + t * (g.corners[2] - g.corners[0]);
  }
  return (1 - t) * ((1 - s) * g.corners[0] + s * g.corners[1]) + t * ((1 - s) * g.corners[3] + s * g.corners[2]);
}
inline Vec3 point_of(const Revolution& g, double s, double t) {
  const double r = g.r0 + s * (g.r1 - g.r0), h = g.h0 + s * (g.h1 - g.h0), angle = 2 * M_PI * t;
  const Vec3 u = perpendicular_to(g.axis), v = cross(g.axis, u);
  return g.base + h * g.axis + r * std::cos(angle) * u + r * std::sin(angle) * v;
}

}  // namespace scree
