#include "runtime/render/case_scene.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>

#include "geometry/bounds.h"
#include "runtime/case_physics.h"
#include "runtime/case_size.h"

namespace scree {

namespace {

constexpr int kFacets = 96;             // that a surface of revolution is drawn with
constexpr double kSmooth = 0.9;         // cosine: facets that meet flatter than this show no edge
constexpr double kJunctionFibres = 9;   // what is round a junction, in fibre diameters
constexpr double kJunctionGrains = 20;  // and at least, in grains

Vec3 normal_of(const Quad& q) {
  const Vec3 n = cross(q.corners[2] - q.corners[0], q.corners[3] - q.corners[1]);
  return norm(n) > 0 ? unit(n) : Vec3{0, 0, 0};
}

std::vector<Quad> quads_of(const Revolution& s) {
  const Vec3 u = perpendicular_to(s.axis), v = cross(s.axis, u);
  const auto point = [&](double r, double h, int k) {
    const double angle = 2 * std::numbers::pi * k / kFacets;
    return s.base + h * s.axis + r * std::cos(angle) * u + r * std::sin(angle) * v;
  };
  std::vector<Quad> quads;
  for (int k = 0; k < kFacets; ++k) {
    const int next = (k + 1) % kFacets;
    quads.push_back({{point(s.r0, s.h0, k), point(s.r0, s.h0, next), point(s.r1, s.h1, next), point(s.r1, s.h1, k)}});
  }
  return quads;
}

// To a millionth of the unit, so that corners that coincide but for rounding are one.
using Corner = std::tuple<int64_t, int64_t, int64_t>;
Corner corner_of(const Vec3& x) { return {std::llround(1e7 * x.x), std::llround(1e7 * x.y), std::llround(1e7 * x.z)}; }

// Edges once each, without those between facets that go on smoothly.
std::vector<Segment> edges_of(const std::vector<Quad>& quads) {
  struct Edge {
    Segment segment;
    Vec3 normal;
    bool smooth = false;
  };
  std::map<std::pair<Corner, Corner>, Edge> edges;
  for (const Quad& q : quads)
    for (int k = 0; k < 4; ++k) {
      const Segment segment{q.corners[k], q.corners[(k + 1) % 4]};
      std::pair<Corner, Corner> ends{corner_of(segment.a), corner_of(segment.b)};
      if (ends.first == ends.second) continue;
      if (ends.second < ends.first) std::swap(ends.first, ends.second);
      const auto [edge, fresh] = edges.try_emplace(ends, Edge{segment, normal_of(q)});
      if (!fresh && std::abs(dot(edge->second.normal, normal_of(q))) > kSmooth) edge->second.smooth = true;
    }
  std::vector<Segment> result;
  for (const auto& [ends, edge] : edges)
    if (!edge.smooth) result.push_back(edge.segment);
  return result;
}

// Where at least two fibres end, nearest to x.
std::optional<Vec3> junction_near(const Solid& solid, const Vec3& x) {
  std::map<Corner, std::pair<Vec3, int>> ends;
  for (const Primitive& p : solid.primitives) {
    const auto* axis = std::get_if<Segment>(&p.skeleton);
    if (!axis || !(p.radius > 0)) continue;
    for (const Vec3& end : {axis->a, axis->b}) ++ends.try_emplace(corner_of(end), end, 0).first->second.second;
  }
  std::optional<Vec3> nearest;
  for (const auto& [corner, end] : ends)
    if (end.second >= 2 && (!nearest || norm(end.first - x) < norm(*nearest - x) * (1 - 1e-9))) nearest = end.first;
  return nearest;
}

double mean_fibre_diameter(const Solid& solid) {
  double sum = 0, count = 0;
  for (const Primitive& p : solid.primitives)
    if (std::holds_alternative<Segment>(p.skeleton)) sum += 2 * p.radius, ++count;
  return count > 0 ? sum / count : 0;
}

}  // namespace

void add_solid(Scene& scene, const Solid& solid, const std::vector<uint32_t>& opened) {
  for (const Primitive& p : solid.primitives) {
    if (std::ranges::find(opened, p.wall) != opened.end()) continue;
    if (const auto* axis = std::get_if<Segment>(&p.skeleton)) scene.fibres.push_back({*axis, p.radius});
    if (const auto* quad = std::get_if<Quad>(&p.skeleton)) scene.walls.push_back(*quad);
    if (const auto* surface = std::get_if<Revolution>(&p.skeleton)) {
      const std::vector<Quad> facets = quads_of(*surface);
      scene.walls.insert(scene.walls.end(), facets.begin(), facets.end());
    }
  }
  scene.wall_edges = edges_of(scene.walls);
}

Bounds region_of_interest(const Case& c, const ParticleFrame& now) {
  Bounds bounds = empty_bounds();
  if (c.fibres.count > 0) bounds = united(bounds, inflated(c.fibres.section, 0.5 * c.fibres.diameter));
  for (const Region& region : c.regions) bounds = united(bounds, bounds_of(region));
  if (!(bounds.min.x <= bounds.max.x))
    for (size_t k = 0; k < now.count(); ++k)
      bounds = united(bounds, inflated({now.positions[k], now.positions[k]}, now.radii[k]));
  return bounds.min.x <= bounds.max.x ? bounds : bounds_of(c.solid);
}

CameraSubject camera_subject(const Case& c, const Bounds& region) {
  CameraSubject subject;
  subject.region = region;
  if (c.fibres.count > 0)
    subject.junction = junction_near(c.solid, 0.5 * (c.fibres.section.min + c.fibres.section.max));
  subject.junction_size = std::max(kJunctionFibres * mean_fibre_diameter(c.solid),
                                   c.kinds.empty() ? 0 : kJunctionGrains * 2 * largest_radius(c));
  return subject;
}

}  // namespace scree
