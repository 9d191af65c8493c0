// What both tracers share, and the slow one.
#include "geometry/ray_tracer.h"

#include "geometry/argument.h"
#include "geometry/bounds.h"

namespace scree {

namespace {

Bounds bounds_of(const TracedBodies& bodies) {
  Bounds all = empty_bounds();
  const auto include = [&](const Vec3& x, double margin) { all = united(all, inflated({x, x}, margin)); };
  for (const Ball& b : bodies.balls) include(b.centre, b.radius);
  for (const Capsule& c : bodies.capsules) include(c.axis.a, c.radius), include(c.axis.b, c.radius);
  for (const Quad& q : bodies.quads)
    for (const Vec3& corner : q.corners) include(corner, 0);
  return all;
}

// A body whose numbers are not finite would spoil the hierarchy of all.
void require_drawable(const char* what, size_t index, double radius, const Vec3& x) {
  require_positive(fmt::format("radius of {} {}", what, index), radius);
  require_finite(fmt::format("largest coordinate of {} {}", what, index),
                 std::abs(x.x) + std::abs(x.y) + std::abs(x.z));
}

QuadBody quad_body(const RayTracer& tracer, const Quad& quad) {
  QuadBody body{};
  const Vec3 diagonals = cross(quad.corners[2] - quad.corners[0], quad.corners[3] - quad.corners[1]);
  const Vec3 normal = norm(diagonals) > 0 ? unit(diagonals) : Vec3{0, 0, 1};
  for (int k = 0; k < 4; ++k) {
    const Vec3 inward = cross(normal, quad.corners[(k + 1) % 4] - quad.corners[k]);
    body.corner[k] = tracer.local(quad.corners[k]);
    body.inward[k] = {float(inward.x), float(inward.y), float(inward.z)};
  }
  body.normal = {float(normal.x), float(normal.y), float(normal.z)};
  return body;
}

class BruteForceTracer final : public RayTracer {
 public:
  explicit BruteForceTracer(TracedBodies bodies) : RayTracer(std::move(bodies)) {}

  void closest(std::span<const Ray> rays, std::span<Hit> hits) const override {
    for (size_t k = 0; k < rays.size(); ++k) {
      hits[k] = {};
      each_hit(rays[k], [&](const Hit& hit) {
        if (hits[k].body.shape == Shape::none || hit.distance < hits[k].distance) hits[k] = hit;
      });
    }
  }
  void any(std::span<const Ray> rays, std::span<uint8_t> blocked) const override {
    for (size_t k = 0; k < rays.size(); ++k) {
      blocked[k] = 0;
      each_hit(rays[k], [&](const Hit&) { blocked[k] = 1; });
    }
  }
  void all(std::span<const Ray> rays, std::vector<Crossing>& crossings) const override {
    for (uint32_t k = 0; k < rays.size(); ++k) {
      const auto first = std::ptrdiff_t(crossings.size());
      each_hit(rays[k], [&](const Hit& hit) { crossings.push_back({k, hit}); });
      std::stable_sort(crossings.begin() + first, crossings.end(),
                       [](const Crossing& a, const Crossing& b) { return a.hit.distance < b.hit.distance; });
    }
  }
  std::optional<BodyId> containing(const Vec3f& x) const override {
    std::optional<BodyId> deepest;
    float most = 0;
    each_body([&](const auto& body, const BodyId& id) {
      if (depth(body, x) > most) most = depth(body, x), deepest = id;
    });
    return deepest;
  }

 private:
  void each_body(const auto& visit) const {
    for (uint32_t k = 0; k < balls_.size(); ++k) visit(balls_[k], BodyId{Shape::ball, k});
    for (uint32_t k = 0; k < capsules_.size(); ++k) visit(capsules_[k], BodyId{Shape::capsule, k});
    for (uint32_t k = 0; k < quads_.size(); ++k) visit(quads_[k], BodyId{Shape::quad, k});
  }
  void each_hit(const Ray& ray, const auto& visit) const {
    each_body([&](const auto& body, const BodyId& id) {
      const Chord inside = chord(body, ray);
      if (inside.in <= inside.out && inside.in >= ray.near && inside.in <= ray.far) visit(Hit{inside.in, id});
    });
  }
};

}  // namespace

RayTracer::RayTracer(TracedBodies bodies) {  // NOLINT(performance-unnecessary-value-param): it takes them
  for (size_t k = 0; k < bodies.balls.size(); ++k)
    require_drawable("sphere", k, bodies.balls[k].radius, bodies.balls[k].centre);
  for (size_t k = 0; k < bodies.capsules.size(); ++k) {
    require_drawable("capsule", k, bodies.capsules[k].radius, bodies.capsules[k].axis.a);
    require_drawable("capsule", k, bodies.capsules[k].radius, bodies.capsules[k].axis.b);
  }
  const Bounds bounds = bounds_of(bodies);
  origin_ = bounds.min.x <= bounds.max.x ? 0.5 * (bounds.min + bounds.max) : Vec3{0, 0, 0};
  balls_.reserve(bodies.balls.size());
  for (const Ball& b : bodies.balls) balls_.push_back({local(b.centre), float(b.radius)});
  for (const Capsule& c : bodies.capsules) {
    const Vec3 edge = c.axis.b - c.axis.a;
    const double length = norm(edge);
    const Vec3 axis = length > 0 ? (1 / length) * edge : Vec3{0, 0, 1};
    capsules_.push_back(
        {local(c.axis.a), {float(axis.x), float(axis.y), float(axis.z)}, float(length), float(c.radius)});
  }
  for (const Quad& q : bodies.quads) quads_.push_back(quad_body(*this, q));
}

Vec3f RayTracer::normal(const BodyId& body, const Vec3f& x) const {
  return body.shape == Shape::ball      ? normal_at(balls_[body.index], x)
         : body.shape == Shape::capsule ? normal_at(capsules_[body.index], x)
                                        : normal_at(quads_[body.index], x);
}

std::unique_ptr<RayTracer> make_brute_force_tracer(TracedBodies bodies) {
  return std::make_unique<BruteForceTracer>(std::move(bodies));
}

}  // namespace scree
