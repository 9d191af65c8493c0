#include "geometry/closest_point.h"

#include "geometry/argument.h"

namespace scree {

namespace {

// A skeleton without length is its first point: t = clamp(0) = 0. The bound keeps 1 / length2 finite.
double inverse_or_zero(double length2) { return length2 > 1e-300 ? 1.0 / length2 : 0.0; }

}  // namespace

SegmentOf<double> prepared(const Segment& segment) {
  const Vec3 edge = segment.b - segment.a;
  require_finite("squared length of a segment", dot(edge, edge), "m2");
  return {segment.a, edge, inverse_or_zero(dot(edge, edge))};
}

QuadOf<double> prepared(const Quad& quad) {
  const auto& c = quad.corners;
  const Vec3 twice_area = cross(c[2] - c[0], c[3] - c[1]);  // of its diagonals; right for a triangle too
  require(norm(twice_area) > 0, "area of a quad", 0.5 * norm(twice_area), "m2", "positive");
  QuadOf<double> result{{c[0], c[1], c[2], c[3]}, unit(twice_area), {}};
  for (int k = 0; k < 4; ++k) result.inverse_length2[k] = prepared(Segment{c[k], c[(k + 1) % 4]}).inverse_length2;
  return result;
}

RevolutionOf<double> prepared(const Revolution& revolution) {
  const auto& [base, axis, r0, h0, r1, h1] = revolution;
  require(std::abs(norm(axis) - 1) < 1e-9, "length of a revolution's axis", norm(axis), "", "1");
  require_finite("squared distance of a revolution's base from the origin", dot(base, base), "m2");
  require_finite("h0 of a revolution", h0);
  require_finite("h1 of a revolution", h1);
  require_not_negative("r0 of a revolution", r0);
  require_not_negative("r1 of a revolution", r1);
  const double dr = r1 - r0, dh = h1 - h0;
  return {base, axis, perpendicular_to(axis), r0, h0, dr, dh, inverse_or_zero(dr * dr + dh * dh)};
}

PreparedPrimitive prepared(const Primitive& primitive) {
  return std::visit(
      [&](const auto& skeleton) {
        return PreparedPrimitive{prepared(skeleton), primitive.radius};
      },
      primitive.skeleton);
}

Vec3 closest_on_skeleton(const PreparedPrimitive& primitive, const Vec3& x) {
  return std::visit([&](const auto& skeleton) { return closest_on(skeleton, x); }, primitive.skeleton);
}

Vec3 closest_on_skeleton(const Primitive& primitive, const Vec3& x) {
  return closest_on_skeleton(prepared(primitive), x);
}

double distance(const PreparedPrimitive& primitive, const Vec3& x) {
  return norm(x - closest_on_skeleton(primitive, x)) - primitive.radius;
}

double distance(const Primitive& primitive, const Vec3& x) { return distance(prepared(primitive), x); }

}  // namespace scree
