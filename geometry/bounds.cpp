#include "geometry/bounds.h"

#include <algorithm>
#include <limits>

namespace scree {

namespace {

Bounds bounds_of(const Segment& segment) { return united({segment.a, segment.a}, {segment.b, segment.b}); }

Bounds bounds_of(const Quad& quad) {
  Bounds result = empty_bounds();
  for (const Vec3& corner : quad.corners) result = united(result, {corner, corner});
  return result;
}

// A circle of radius r round a unit axis n reaches r sqrt(1 - n_k^2) from its centre along coordinate k.
Bounds bounds_of_circle(const Vec3& centre, const Vec3& axis, double radius) {
  const auto reach = [radius](double cosine) { return radius * std::sqrt(std::max(0.0, 1 - cosine * cosine)); };
  const Vec3 half{reach(axis.x), reach(axis.y), reach(axis.z)};
  return {centre - half, centre + half};
}

// Every point lies between its two end circles, so they hold the extremes.
Bounds bounds_of(const Revolution& revolution) {
  const auto& [base, axis, r0, h0, r1, h1] = revolution;
  return united(bounds_of_circle(base + h0 * axis, axis, r0), bounds_of_circle(base + h1 * axis, axis, r1));
}

}  // namespace

Bounds empty_bounds() {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  return {{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
}

Bounds bounds_of(const Primitive& primitive) {
  return std::visit([&](const auto& skeleton) { return inflated(bounds_of(skeleton), primitive.radius); },
                    primitive.skeleton);
}

Bounds bounds_of(const Solid& solid) {
  Bounds result = empty_bounds();
  for (const Primitive& primitive : solid.primitives) result = united(result, bounds_of(primitive));
  return result;
}

Bounds united(const Bounds& a, const Bounds& b) {
  return {{std::min(a.min.x, b.min.x), std::min(a.min.y, b.min.y), std::min(a.min.z, b.min.z)},
          {std::max(a.max.x, b.max.x), std::max(a.max.y, b.max.y), std::max(a.max.z, b.max.z)}};
}

Bounds inflated(const Bounds& bounds, double margin) {
  const Vec3 shift{margin, margin, margin};
  return {bounds.min - shift, bounds.max + shift};
}

bool contains(const Bounds& bounds, const Vec3& x) {
  return bounds.min.x <= x.x && x.x <= bounds.max.x && bounds.min.y <= x.y && x.y <= bounds.max.y &&
         bounds.min.z <= x.z && x.z <= bounds.max.z;
}

double volume_of(const Bounds& bounds) {
  const Vec3 size = bounds.max - bounds.min;
  return std::max(0.0, size.x) * std::max(0.0, size.y) * std::max(0.0, size.z);
}

}  // namespace scree
