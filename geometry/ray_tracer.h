// Rays in, hits out: what a picture is traced with. Two implementations that answer alike: Embree's bounding volume
// hierarchy, and its slow, obvious twin, which is its oracle. Neither changes after it is made. Lengths in m.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "geometry/ray.h"
#include "geometry/solid.h"

namespace scree {

struct Ball {
  Vec3 centre;
  double radius;  // m, > 0
};
struct Capsule {
  Segment axis;
  double radius;  // m, > 0
};

struct TracedBodies {
  std::vector<Ball> balls;
  std::vector<Capsule> capsules;
  std::vector<Quad> quads;
};

enum class Shape : uint32_t { ball, capsule, quad, none };

// A body: its shape and its index in the list that it came from.
struct BodyId {
  Shape shape = Shape::none;
  uint32_t index = 0;
  bool operator==(const BodyId&) const = default;
};

struct Hit {
  float distance = 0;  // along the ray
  BodyId body;         // Shape::none: nothing is hit
};

struct Crossing {
  uint32_t ray;  // index in the span of rays
  Hit hit;
};

// A ray hits a body where it enters it, between near and far. A body that it starts inside of is not seen: surfaces do
// not shade themselves, and containing() says what a cut through a body shows.
class RayTracer {
 public:
  virtual ~RayTracer() = default;

  // What rays are relative to, m: a ray's origin is a point of the world minus this.
  Vec3 origin() const { return origin_; }
  Vec3f local(const Vec3& world) const {
    return {float(world.x - origin_.x), float(world.y - origin_.y), float(world.z - origin_.z)};
  }

  // Thread-safe. hits.size() = blocked.size() = rays.size(). Fastest when rays that are near each other are neighbours.
  virtual void closest(std::span<const Ray> rays, std::span<Hit> hits) const = 0;
  virtual void any(std::span<const Ray> rays, std::span<uint8_t> blocked) const = 0;  // 1: something is hit
  // Everything that each ray hits, appended by ray and then by distance.
  virtual void all(std::span<const Ray> rays, std::vector<Crossing>& crossings) const = 0;
  // The ball or capsule that x (local) is deepest inside of; of equals the first.
  virtual std::optional<BodyId> containing(const Vec3f& x) const = 0;

  // The outward unit normal at a point of a body's surface, local.
  Vec3f normal(const BodyId& body, const Vec3f& x) const;

 protected:
  explicit RayTracer(TracedBodies bodies);

  Vec3 origin_;
  std::vector<BallBody> balls_;
  std::vector<CapsuleBody> capsules_;
  std::vector<QuadBody> quads_;
};

// Take the bodies, which are gone by the time that a hierarchy is built of smaller ones (ten million balls are 320 MB
// as they come, 160 MB as they are kept). Throw std::invalid_argument for one whose numbers are not finite or whose
// radius is not positive, std::runtime_error if Embree fails.
std::unique_ptr<RayTracer> make_embree_tracer(TracedBodies bodies);
std::unique_ptr<RayTracer> make_brute_force_tracer(TracedBodies bodies);
// With so many balls to a leaf of the hierarchy: less memory, slower. The one above takes as many as this says: two of
// four million balls on, where neighbours in the list are neighbours in space (as after a fill they are not), else one.
std::unique_ptr<RayTracer> make_embree_tracer(TracedBodies bodies, size_t balls_together);
size_t balls_together(std::span<const Ball> balls);

}  // namespace scree
