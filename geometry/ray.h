// Rays, and the stretch of a ray that lies inside a body: an interval, because every body here is convex. Pure
// functions in float, in coordinates near the origin, where floats are fine. Lengths in m.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/vec.h"

namespace scree {

using Vec3f = Vec<float>;

// The points origin + t direction, near <= t <= far; direction is of unit length.
struct Ray {
  Vec3f origin;
  float near = 0;
  Vec3f direction;
  float far = std::numeric_limits<float>::infinity();
};

inline Vec3f point_at(const Ray& ray, float t) { return ray.origin + t * ray.direction; }

// in <= t <= out; in > out: nothing. The ray's near and far are not looked at.
struct Chord {
  float in = std::numeric_limits<float>::infinity(), out = -std::numeric_limits<float>::infinity();
};

struct BallBody {
  Vec3f centre;
  float radius;
};

// All points within `radius` of the segment a + s axis, 0 <= s <= length.
struct CapsuleBody {
  Vec3f a, axis;  // unit
  float length, radius;
};

// A convex planar quadrilateral; a triangle repeats its last corner. It has no inside: in = out.
struct QuadBody {
  Vec3f corner[4];
  Vec3f inward[4];  // in the plane, from edge k (corner k to k + 1) to the inside
  Vec3f normal;     // unit
};

// The point of the line nearest to the centre first: what is small is then computed from small numbers, and a body far
// from the ray's origin is as round as a near one.
inline Chord chord(const BallBody& ball, const Ray& ray) {
  const float middle = dot(ball.centre - ray.origin, ray.direction);
  const Vec3f offset = point_at(ray, middle) - ball.centre;
  const float half2 = ball.radius * ball.radius - dot(offset, offset);
  if (!(half2 >= 0)) return {};
  const float half = std::sqrt(half2);
  return {middle - half, middle + half};
}

// Of the cylinder between the two end planes, without its rounded ends.
inline Chord barrel_chord(const CapsuleBody& capsule, const Ray& ray) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const auto across = [&](const Vec3f& v) { return v - dot(v, capsule.axis) * capsule.axis; };
  const Vec3f direction = across(ray.direction), origin = across(ray.origin - capsule.a);
  const float rate2 = dot(direction, direction);
  Chord inside{-infinity, infinity};
  if (rate2 > 1e-12f) {
    const float middle = -dot(origin, direction) / rate2;
    const Vec3f offset = origin + middle * direction;
    const float half2 = (capsule.radius * capsule.radius - dot(offset, offset)) / rate2;
    if (!(half2 >= 0)) return {};
    inside = {middle - std::sqrt(half2), middle + std::sqrt(half2)};
  } else if (dot(origin, origin) > capsule.radius * capsule.radius) {
    return {};  // along the axis, outside
  }
  const float start = dot(ray.origin - capsule.a, capsule.axis), speed = dot(ray.direction, capsule.axis);
  if (std::abs(speed) > 1e-12f) {
    const float t0 = -start / speed, t1 = (capsule.length - start) / speed;
    inside = {std::max(inside.in, std::min(t0, t1)), std::min(inside.out, std::max(t0, t1))};
  } else if (start < 0 || start > capsule.length) {
    return {};
  }
  return inside.in <= inside.out ? inside : Chord{};
}

// The capsule is the barrel and two balls, and convex: its chord is the hull of theirs.
inline Chord chord(const CapsuleBody& capsule, const Ray& ray) {
  const Chord parts[] = {barrel_chord(capsule, ray), chord(BallBody{capsule.a, capsule.radius}, ray),
                         chord(BallBody{capsule.a + capsule.length * capsule.axis, capsule.radius}, ray)};
  Chord all;
  for (const Chord& part : parts) all = {std::min(all.in, part.in), std::max(all.out, part.out)};
  return all;
}

inline Chord chord(const QuadBody& quad, const Ray& ray) {
  const float rate = dot(ray.direction, quad.normal);
  if (std::abs(rate) < 1e-12f) return {};
  const float t = dot(quad.corner[0] - ray.origin, quad.normal) / rate;
  const Vec3f x = point_at(ray, t);
  for (int k = 0; k < 4; ++k)
    if (dot(x - quad.corner[k], quad.inward[k]) < 0) return {};
  return {t, t};
}

// How deep x is inside, m; negative: outside.
inline float depth(const BallBody& ball, const Vec3f& x) {
  const Vec3f d = x - ball.centre;
  return ball.radius - std::sqrt(dot(d, d));
}
inline Vec3f nearest_on_axis(const CapsuleBody& capsule, const Vec3f& x) {
  return capsule.a + std::clamp(dot(x - capsule.a, capsule.axis), 0.0f, capsule.length) * capsule.axis;
}
inline float depth(const CapsuleBody& capsule, const Vec3f& x) {
  return depth(BallBody{nearest_on_axis(capsule, x), capsule.radius}, x);
}
inline float depth(const QuadBody&, const Vec3f&) { return -std::numeric_limits<float>::infinity(); }

// The outward unit normal at a point x of the surface.
inline Vec3f normal_at(const BallBody& ball, const Vec3f& x) { return (1 / ball.radius) * (x - ball.centre); }
inline Vec3f normal_at(const CapsuleBody& capsule, const Vec3f& x) {
  return (1 / capsule.radius) * (x - nearest_on_axis(capsule, x));
}
inline Vec3f normal_at(const QuadBody& quad, const Vec3f&) { return quad.normal; }

}  // namespace scree
