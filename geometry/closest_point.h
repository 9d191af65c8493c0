// The point of a skeleton closest to a point x, for one x (T = double) or one x per lane (T = a SIMD type): the same
// source. Pure functions, free of branches; what T must offer is listed in geometry/number.h. Lengths in m.
//
// Each skeleton has a prepared form XOf<T> that holds what does not depend on x. prepared() makes it in double from
// the plain nouns of geometry/solid.h; a lane loop fills the same struct with broadcast or gathered lanes.
#pragma once

#include <variant>

#include "geometry/number.h"
#include "geometry/solid.h"
#include "geometry/vec.h"

namespace scree {

template <class T>
struct SegmentOf {
  Vec<T> a, edge;     // the points a + t edge, 0 <= t <= 1
  T inverse_length2;  // 1 / edge.edge, 1/m2; 0 for a segment without length, which is then the point a
};

template <class T>
struct QuadOf {
  Vec<T> corners[4];     // planar and convex, in order; repeated corners are allowed
  Vec<T> normal;         // unit; the corners turn anticlockwise round it
  T inverse_length2[4];  // of the edge corners[k] -> corners[k + 1], as in SegmentOf
};

template <class T>
struct RevolutionOf {
  Vec<T> base, axis, perpendicular;  // axis and perpendicular are unit vectors at a right angle
  T r0, h0, dr, dh;                  // the points (r0 + t dr, h0 + t dh), 0 <= t <= 1, turned round the axis
  T inverse_length2;                 // 1 / (dr^2 + dh^2), as in SegmentOf
};

template <class T>
inline T clamp_to_unit(const T& t) {
  return min(max(t, T(0)), T(1));
}

// The point a + t edge, 0 <= t <= 1, closest to x.
template <class T>
inline Vec<T> closest_on_segment(const Vec<T>& a, const Vec<T>& edge, const T& inverse_length2, const Vec<T>& x) {
  return a + clamp_to_unit(T(dot(x - a, edge) * inverse_length2)) * edge;
}

template <class T>
inline Vec<T> closest_on(const SegmentOf<T>& segment, const Vec<T>& x) {
  return closest_on_segment(segment.a, segment.edge, segment.inverse_length2, x);
}

// The foot of the perpendicular where it falls inside all four edges, else the closest point of the four edges.
// An edge without length (a triangle) has x on its inner side always and never wins against its neighbours.
template <class T>
inline Vec<T> closest_on(const QuadOf<T>& quad, const Vec<T>& x) {
  const Vec<T> foot = x - dot(x - quad.corners[0], quad.normal) * quad.normal;
  auto inside = T(0) <= T(0);
  Vec<T> closest = quad.corners[0];
  T closest2 = dot(x - closest, x - closest);
  for (int k = 0; k < 4; ++k) {
    const Vec<T> edge = quad.corners[(k + 1) % 4] - quad.corners[k];
    inside = inside & (dot(quad.normal, cross(edge, x - quad.corners[k])) >= T(0));
    const Vec<T> candidate = closest_on_segment(quad.corners[k], edge, quad.inverse_length2[k], x);
    const T candidate2 = dot(x - candidate, x - candidate);
    closest = select_vec(candidate2 < closest2, candidate, closest);
    closest2 = min(candidate2, closest2);
  }
  return select_vec(inside, foot, closest);
}

// In the half-plane through x the skeleton is a segment and x is (r, h):
//
//      h |     .x            The radial direction comes from two fixed perpendiculars, so it is perpendicular to the
//        |   q/              axis even where r is nothing but round-off; on the axis itself (r < 1e-15 m) every
//        |   /               direction is as good, and the fixed one is taken.
//        +---------- r
template <class T>
inline Vec<T> closest_on(const RevolutionOf<T>& surface, const Vec<T>& x) {
  const Vec<T> from_base = x - surface.base;
  const Vec<T> third = cross(surface.axis, surface.perpendicular);
  const T p = dot(from_base, surface.perpendicular);
  const T q = dot(from_base, third);
  const T h = dot(from_base, surface.axis);
  const T r2 = p * p + q * q;
  const auto off_axis = r2 > T(1e-30);
  const T r = sqrt(select(off_axis, r2, T(1)));
  const T cosine = select(off_axis, T(p / r), T(1));
  const T sine = select(off_axis, T(q / r), T(0));
  const T distance_from_axis = select(off_axis, r, T(0));
  const T along = (distance_from_axis - surface.r0) * surface.dr + (h - surface.h0) * surface.dh;
  const T t = clamp_to_unit(T(along * surface.inverse_length2));
  const Vec<T> radial = cosine * surface.perpendicular + sine * third;
  return surface.base + (surface.h0 + t * surface.dh) * surface.axis + (surface.r0 + t * surface.dr) * radial;
}

// Throw std::invalid_argument for a number that is not finite, a quad without area, an axis that is not of unit length,
// a negative radius.
SegmentOf<double> prepared(const Segment& segment);
QuadOf<double> prepared(const Quad& quad);
RevolutionOf<double> prepared(const Revolution& revolution);

// A primitive's surface, prepared for repeated distance queries in double.
struct PreparedPrimitive {
  std::variant<SegmentOf<double>, QuadOf<double>, RevolutionOf<double>> skeleton;
  double radius;  // m
};
PreparedPrimitive prepared(const Primitive& primitive);

Vec3 closest_on_skeleton(const PreparedPrimitive& primitive, const Vec3& x);
Vec3 closest_on_skeleton(const Primitive& primitive, const Vec3& x);

// From x to the primitive's surface, m: |x - closest point of the skeleton| - radius. Negative inside a rounded one.
double distance(const PreparedPrimitive& primitive, const Vec3& x);
double distance(const Primitive& primitive, const Vec3& x);

}  // namespace scree
