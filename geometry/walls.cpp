#include "geometry/walls.h"

#include <algorithm>

#include "geometry/argument.h"
#include "geometry/bounds.h"

namespace scree {

namespace {

Primitive primitive_of(const std::variant<Segment, Quad, Revolution>& skeleton, double radius,
                       const SurfaceLabel& label) {
  return {skeleton, radius, label.material, label.wall};
}

void require_finite_vector(std::string_view name, const Vec3& v) {
  require_finite(fmt::format("{}.x", name), v.x);
  require_finite(fmt::format("{}.y", name), v.y);
  require_finite(fmt::format("{}.z", name), v.z);
}

Vec3 direction_of(std::string_view name, const Vec3& v) {
  require_finite_vector(name, v);
  const double length = norm(v);
  require(length > 0 && std::isfinite(length), fmt::format("length of {}", name), length, "", "in (0, inf)");
  return (1 / length) * v;
}

void require_box(std::string_view name, const Bounds& box) {
  require_finite_vector(fmt::format("{}.min", name), box.min);
  require_finite_vector(fmt::format("{}.max", name), box.max);
  const auto ordered = [&](char coordinate, double low, double high) {
    require(low < high, fmt::format("{}.max.{}", name, coordinate), high, "m",
            fmt::format("above {}.min.{} = {:g} m", name, coordinate, low));
  };
  ordered('x', box.min.x, box.max.x);
  ordered('y', box.min.y, box.max.y);
  ordered('z', box.min.z, box.max.z);
}

// Twice the vector area of the triangles at each corner must point the same way as the whole: convex, no self-crossing.
void require_planar_convex(const std::array<Vec3, 4>& c) {
  const Vec3 diagonal = c[2] - c[0], other = c[3] - c[1];
  const double area = 0.5 * norm(cross(diagonal, other));
  const double size2 = std::max(dot(diagonal, diagonal), dot(other, other));
  require(area > 1e-12 * size2, "area of quad", area, "m2",
          fmt::format("above {:g} m2: corners lie on a line", 1e-12 * size2));
  const Vec3 normal = unit(cross(diagonal, other));
  const double warp = std::abs(dot(c[1] - c[0], normal));
  require(warp <= 1e-6 * std::sqrt(size2), "warp of quad", warp, "m",
          fmt::format("in [0, {:g}] m: corners in one plane", 1e-6 * std::sqrt(size2)));
  for (int k = 0; k < 4; ++k) {
    const double turn = dot(cross(c[(k + 1) % 4] - c[k], c[(k + 2) % 4] - c[(k + 1) % 4]), normal);
    require(turn >= -1e-9 * size2, fmt::format("turn of quad at corner {}", (k + 1) % 4), turn, "m2",
            "in [0, inf) m2: corners in order round a convex shape");
  }
}

// Where the plane cuts the edges of the box.
std::vector<Vec3> cut_points(const Vec3& point, const Vec3& normal, const Bounds& box) {
  const auto corner = [&](int bits) {
    return Vec3{bits & 1 ? box.max.x : box.min.x, bits & 2 ? box.max.y : box.min.y, bits & 4 ? box.max.z : box.min.z};
  };
  std::vector<Vec3> points;
  for (int from = 0; from < 8; ++from) {
    for (const int to : {from | 1, from | 2, from | 4}) {
      if (to == from) continue;
      const Vec3 a = corner(from), b = corner(to);
      const double above_a = dot(a - point, normal), above_b = dot(b - point, normal);
      if (above_a == 0) points.push_back(a);
      if (above_b == 0) points.push_back(b);
      if (above_a * above_b < 0) points.push_back(a + (above_a / (above_a - above_b)) * (b - a));
    }
  }
  return points;
}

Primitives revolution(const Vec3& base, const Vec3& axis, const std::array<Vec3, 2>& profile,
                      const SurfaceLabel& label) {
  require_finite_vector("base", base);
  const auto& [start, end] = profile;  // x: distance from the axis, z: height
  return {primitive_of(Revolution{base, direction_of("axis", axis), start.x, start.z, end.x, end.z}, 0, label)};
}

}  // namespace

Primitives quad(const std::array<Vec3, 4>& corners, const SurfaceLabel& label) {
  for (int k = 0; k < 4; ++k) require_finite_vector(fmt::format("corner {}", k), corners[k]);
  require_planar_convex(corners);
  return {primitive_of(Quad{{corners[0], corners[1], corners[2], corners[3]}}, 0, label)};
}

Primitives rectangle(const Vec3& corner, const Vec3& edge, const Vec3& other_edge, const SurfaceLabel& label) {
  const double cosine = dot(direction_of("edge", edge), direction_of("other_edge", other_edge));
  require(std::abs(cosine) < 1e-6, "cosine between edge and other_edge", cosine, "", "0: a right angle");
  return quad({corner, corner + edge, corner + edge + other_edge, corner + other_edge}, label);
}

Primitives plane(const Vec3& point, const Vec3& normal, const Bounds& domain, const SurfaceLabel& label) {
  require_finite_vector("point", point);
  require_box("domain", domain);
  const Vec3 n = direction_of("normal", normal);
  const Vec3 u = perpendicular_to(n), v = cross(n, u);
  double u0 = INFINITY, u1 = -INFINITY, v0 = INFINITY, v1 = -INFINITY;
  for (const Vec3& p : cut_points(point, n, domain)) {
    u0 = std::min(u0, dot(p - point, u)), u1 = std::max(u1, dot(p - point, u));
    v0 = std::min(v0, dot(p - point, v)), v1 = std::max(v1, dot(p - point, v));
  }
  require(u0 < u1 && v0 < v1, "distance of the plane from the domain's centre",
          std::abs(dot(0.5 * (domain.min + domain.max) - point, n)), "m",
          "small enough for the plane to cut the domain");
  return rectangle(point + u0 * u + v0 * v, (u1 - u0) * u, (v1 - v0) * v, label);
}

Primitives box_walls(const Bounds& box, const BoxFaces& faces, const SurfaceLabel& label) {
  require_box("box", box);
  const Vec3 size = box.max - box.min;
  const Vec3 x{size.x, 0, 0}, y{0, size.y, 0}, z{0, 0, size.z};
  Primitives walls;
  const auto add = [&](bool wanted, const Vec3& corner, const Vec3& edge, const Vec3& other) {
    if (wanted) walls.push_back(rectangle(corner, edge, other, label).front());
  };
  add(faces.x_min, box.min, y, z);
  add(faces.x_max, box.min + x, y, z);
  add(faces.y_min, box.min, z, x);
  add(faces.y_max, box.min + y, z, x);
  add(faces.z_min, box.min, x, y);
  add(faces.z_max, box.min + z, x, y);
  return walls;
}

Primitives channel(const Bounds& box, const SurfaceLabel& label) {
  return box_walls(box, {.z_min = false, .z_max = false}, label);
}

Primitives frustum(const Frustum& shape, const SurfaceLabel& label) {
  require_finite("centre_x", shape.centre_x);
  require_finite("centre_y", shape.centre_y);
  require_positive("bottom_x", shape.bottom_x);
  require_positive("bottom_y", shape.bottom_y);
  require_positive("top_x", shape.top_x);
  require_positive("top_y", shape.top_y);
  require_finite("z0", shape.z0);
  require_finite("z1", shape.z1);
  require(shape.z1 > shape.z0, "z1", shape.z1, "m", fmt::format("above z0 = {:g} m", shape.z0));
  static constexpr double kSideX[] = {-0.5, 0.5, 0.5, -0.5}, kSideY[] = {-0.5, -0.5, 0.5, 0.5};
  const auto corner = [&](int k, double z, double side_x, double side_y) {
    return Vec3{shape.centre_x + kSideX[k % 4] * side_x, shape.centre_y + kSideY[k % 4] * side_y, z};
  };
  const auto bottom = [&](int k) { return corner(k, shape.z0, shape.bottom_x, shape.bottom_y); };
  const auto top = [&](int k) { return corner(k, shape.z1, shape.top_x, shape.top_y); };
  Primitives panels;
  for (int k = 0; k < 4; ++k) panels.push_back(quad({bottom(k), bottom(k + 1), top(k + 1), top(k)}, label).front());
  return panels;
}

Primitives cylinder(const Vec3& base, const Vec3& axis, double radius, double height, const SurfaceLabel& label) {
  require_positive("radius", radius);
  require_positive("height", height);
  return revolution(base, axis, {Vec3{radius, 0, 0}, {radius, 0, height}}, label);
}

Primitives cone(const Cone& shape, const SurfaceLabel& label) {
  require_not_negative("base_radius", shape.base_radius);
  require_not_negative("top_radius", shape.top_radius);
  require(shape.base_radius + shape.top_radius > 0, "top_radius", shape.top_radius, "m",
          "in (0, inf) m if base_radius is 0");
  require_positive("height", shape.height);
  return revolution(shape.base, shape.axis, {Vec3{shape.base_radius, 0, 0}, {shape.top_radius, 0, shape.height}},
                    label);
}

Primitives disc(const Vec3& centre, const Vec3& axis, double radius, const SurfaceLabel& label) {
  require_positive("radius", radius);
  return revolution(centre, axis, {Vec3{0, 0, 0}, {radius, 0, 0}}, label);
}

Primitives annulus(const Vec3& centre, const Vec3& axis, double inner_radius, double outer_radius,
                   const SurfaceLabel& label) {
  require_not_negative("inner_radius", inner_radius);
  require(outer_radius > inner_radius && std::isfinite(outer_radius), "outer_radius", outer_radius, "m",
          fmt::format("above inner_radius = {:g} m", inner_radius));
  return revolution(centre, axis, {Vec3{inner_radius, 0, 0}, {outer_radius, 0, 0}}, label);
}

Primitives fibre_network(std::span<const Segment> axes, double diameter, const SurfaceLabel& label) {
  require_positive("fibre diameter", diameter);
  Primitives fibres;
  fibres.reserve(axes.size());
  for (size_t k = 0; k < axes.size(); ++k) {
    require_finite_vector(fmt::format("start of fibre {}", k), axes[k].a);
    require_finite_vector(fmt::format("end of fibre {}", k), axes[k].b);
    fibres.push_back(primitive_of(axes[k], 0.5 * diameter, label));
  }
  return fibres;
}

}  // namespace scree
