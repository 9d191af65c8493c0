#include "runtime/touch_surface.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/bounds.h"
#include "geometry/closest_point.h"
#include "geometry/solid_index.h"
#include "kernels/parallel.h"
#include "runtime/case_physics.h"

namespace scree {

namespace {

constexpr double kOnSurface = 1e-9;  // m: closer than this to a surface counts as on it
constexpr double kRoom = 1e-3;       // of a radius: what a grain may lack and still fit

uint32_t pieces(double length, double cell) {
  return static_cast<uint32_t>(std::clamp(std::round(length / cell), 1.0, 1e9));
}

Vec3 up_of(const Case& c) { return norm(c.gravity) > 0 ? unit(-c.gravity) : Vec3{0, 0, 1}; }

// The part of `wanted` perpendicular to the unit vector `axis`, made a unit vector; any perpendicular if there is none.
Vec3 turned_off(const Vec3& axis, const Vec3& wanted) {
  const Vec3 rest = wanted - dot(wanted, axis) * axis;
  return norm(rest) > 1e-6 ? unit(rest) : perpendicular_to(axis);
}

TouchPatch fibre_patch(const Segment& s, double radius, const Vec3& up, const TouchSettings& touch) {
  TouchPatch p;
  p.fibre = true, p.radius = radius;
  const bool turned = dot(s.b - s.a, up) < 0;
  p.origin = turned ? s.b : s.a;
  const Vec3 edge = turned ? s.a - s.b : s.b - s.a;
  p.length = norm(edge), p.width = 2 * std::numbers::pi * radius;
  p.along = p.length > 0 ? unit(edge) : up;
  p.normal = turned_off(p.along, up);
  p.across = cross(p.along, p.normal);
  p.rows = pieces(p.length, touch.cell), p.columns = static_cast<uint32_t>(touch.around);
  return p;
}

TouchPatch face_patch(const Quad& face, const Vec3& up, double cell) {
  TouchPatch p;
  p.normal = prepared(face).normal;
  p.along = turned_off(p.normal, up);
  p.across = cross(p.along, p.normal);
  double low[2] = {1e300, 1e300}, high[2] = {-1e300, -1e300};
  for (const Vec3& corner : face.corners) {
    const Vec3 from = corner - face.corners[0];
    const double at[2] = {dot(from, p.along), dot(from, p.across)};
    for (int k = 0; k < 2; ++k) low[k] = std::min(low[k], at[k]), high[k] = std::max(high[k], at[k]);
  }
  p.origin = face.corners[0] + low[0] * p.along + low[1] * p.across;
  p.length = high[0] - low[0], p.width = high[1] - low[1];
  p.rows = pieces(p.length, cell), p.columns = pieces(p.width, cell);
  return p;
}

bool is_fibre(const Primitive& p) { return p.radius > 0 && std::holds_alternative<Segment>(p.skeleton); }

// Whether a wall stands between x and the section's middle, close to x: the outer half of a fibre in a wall's plane.
bool is_beyond(const PreparedPrimitive& wall, const Vec3& middle, const Vec3& x) {
  const auto* face = std::get_if<QuadOf<double>>(&wall.skeleton);
  if (!face) return false;
  const Vec3 from = x - closest_on(*face, x);
  const double height = dot(from, face->normal);
  const bool beside = norm(from - height * face->normal) > kOnSurface;  // past its edge
  return !beside && std::abs(height) > kOnSurface && height * dot(middle - face->corners[0], face->normal) < 0;
}

bool is_on_face(const PreparedPrimitive& face, const Vec3& x) { return distance(face, x) < kOnSurface; }

// What the state of a cell depends on.
struct Surroundings {
  std::vector<PreparedPrimitive> things;  // by primitive of the case
  std::vector<bool> fibre, gone;          // gone: a wall that a stage opens
  std::unique_ptr<SolidIndex> index;
  Vec3 middle{};
  double grain = 0;  // m, radius of the smallest

  explicit Surroundings(const Case& c) : index(make_embree_index(c.solid)), grain(smallest_radius(c)) {
    for (const Primitive& p : c.solid.primitives) {
      things.push_back(prepared(p)), fibre.push_back(is_fibre(p));
      gone.push_back(!is_fibre(p) && is_opened(c, p.wall));
    }
    const Bounds& b = c.fibres.count > 0 ? c.fibres.section : c.domain;
    middle = 0.5 * (b.min + b.max);
  }

  TouchState state_at(const TouchPatch& patch, const Vec3& x, const Vec3& outward) const {
    std::vector<uint32_t> near;
    index->query(x, std::max(2 * patch.radius, kOnSurface), near);
    for (const uint32_t k : near) {
      if (k == patch.primitive || gone[k]) continue;
      if (fibre[k] && distance(things[k], x) < -kOnSurface) return TouchState::hidden;
      if (patch.fibre && is_beyond(things[k], middle, x)) return TouchState::hidden;
    }
    if (!patch.fibre && !is_on_face(things[patch.primitive], x)) return TouchState::hidden;
    if (patch.fibre) return has_room(patch, x + grain * outward) ? TouchState::open : TouchState::out_of_reach;
    return has_room(patch, x + grain * outward) || has_room(patch, x - grain * outward) ? TouchState::open
                                                                                        : TouchState::out_of_reach;
  }

  bool has_room(const TouchPatch& patch, const Vec3& centre) const {
    std::vector<uint32_t> near;
    index->query(centre, (1 - kRoom) * grain, near);
    return std::ranges::all_of(near, [&](uint32_t k) { return k == patch.primitive || gone[k]; });
  }
};

Vec3 nearest_image(const Vec3& d, const Vec3& period, const Vec3& inverse) {
  return {d.x - period.x * std::round(d.x * inverse.x), d.y - period.y * std::round(d.y * inverse.y),
          d.z - period.z * std::round(d.z * inverse.z)};
}

}  // namespace

Vec3 TouchPatch::outward(double across_share) const {
  if (!fibre) return normal;
  const double a = 2 * std::numbers::pi * across_share;
  return std::cos(a) * normal + std::sin(a) * across;
}

Vec3 TouchPatch::at(double s, double across_share) const {
  if (fibre) return origin + s * along + radius * outward(across_share);
  return origin + s * along + (across_share * width) * across;
}

TouchSurface::TouchSurface(const Case& c) : patch_of_(c.solid.primitives.size(), kNoPatch) {
  const TouchSettings& touch = c.output.touch;
  const Vec3 up = up_of(c), size = c.domain.max - c.domain.min;
  const auto along = [&](int axis, double length) { return c.periodic[axis] ? length : 0; };
  const auto inverse = [](double length) { return length > 0 ? 1 / length : 0; };
  period_ = {along(0, size.x), along(1, size.y), along(2, size.z)};
  inverse_period_ = {inverse(period_.x), inverse(period_.y), inverse(period_.z)};
  size_t cells = 0;
  for (uint32_t k = 0; k < c.solid.primitives.size(); ++k) {
    const Primitive& p = c.solid.primitives[k];
    TouchPatch patch;
    if (is_fibre(p))
      patch = fibre_patch(std::get<Segment>(p.skeleton), p.radius, up, touch);
    else if (is_mapped_face(p, touch))
      patch = face_patch(std::get<Quad>(p.skeleton), up, touch.cell);
    else
      continue;
    patch.primitive = k, patch.first = cells;
    cells += patch.cells();
    patch_of_[k] = static_cast<uint32_t>(patches_.size());
    patches_.push_back(patch);
  }
  states_.resize(cells, TouchState::hidden);
  if (cells > 0) look_what_is_open(c);
}

void TouchSurface::look_what_is_open(const Case& c) {
  const Surroundings around(c);
  parallel_for(patches_.size(), [&](size_t k) {
    const TouchPatch& p = patches_[k];
    for (size_t cell = 0; cell < p.cells(); ++cell) {
      const size_t row = cell / p.columns, column = cell % p.columns;
      const double s = p.length * (static_cast<double>(row) + 0.5) / p.rows;
      const double share = (static_cast<double>(column) + 0.5) / p.columns;
      states_[p.first + cell] = around.state_at(p, p.at(s, share), p.outward(share));
    }
  });
}

size_t TouchSurface::cell_of(size_t primitive, const Vec3& point) const {
  if (patch_of_[primitive] == kNoPatch) return kNone;
  const TouchPatch& p = patches_[patch_of_[primitive]];
  const Vec3 middle =
      p.fibre ? p.origin + 0.5 * p.length * p.along : p.origin + 0.5 * (p.length * p.along + p.width * p.across);
  const Vec3 from = nearest_image(point - middle, period_, inverse_period_) + middle - p.origin;
  const double s = dot(from, p.along) / p.length;
  double share = dot(from, p.across) / p.width;
  if (p.fibre) {
    share = std::atan2(dot(from, p.across), dot(from, p.normal)) / (2 * std::numbers::pi);
    share -= std::floor(share);
    if (s < 0 || s > 1) return kNone;
  }
  const auto index = [](double x, uint32_t n) { return size_t(std::clamp(std::floor(x * n), 0.0, n - 1.0)); };
  return p.first + index(s, p.rows) * p.columns + index(share, p.columns);
}

bool is_opened(const Case& c, uint32_t wall) {
  return std::ranges::any_of(c.stages, [&](const Stage& s) {
    const auto* open = std::get_if<OpenStage>(&s.action);
    return open && std::ranges::find(open->walls, c.solid.walls[wall]) != open->walls.end();
  });
}

bool is_mapped_face(const Primitive& p, const TouchSettings& touch) {
  return p.radius == 0 && std::holds_alternative<Quad>(p.skeleton) &&
         std::ranges::find(touch.walls, p.wall) != touch.walls.end();
}

double area_of_rectangle_round(const Quad& face) {
  const TouchPatch p = face_patch(face, {0, 0, 1}, 1);
  return p.length * p.width;
}

double cells_of_touch(const Case& c) {
  const TouchSettings& touch = c.output.touch;
  double cells = 0;
  for (const Primitive& p : c.solid.primitives) {
    if (const auto* s = std::get_if<Segment>(&p.skeleton); s && is_fibre(p))
      cells += std::max(1.0, norm(s->b - s->a) / touch.cell) * static_cast<double>(touch.around);
    else if (is_mapped_face(p, touch))
      cells += area_of_rectangle_round(std::get<Quad>(p.skeleton)) / (touch.cell * touch.cell);
  }
  return cells;
}

}  // namespace scree
