// Rays through Embree's hierarchy. All bodies are user geometry: measured as fast as Embree's own spheres, a ray along
// the axis of a fibre is right (Embree 3.13 misses its own round curves there), and a point query finds the bodies
// round a point, which Embree's own spheres and curves do not offer.
#include <algorithm>
#include <cmath>

#include "geometry/embree.h"
#include "geometry/ray_tracer.h"

namespace scree {

namespace {

constexpr uint32_t kPacket = 8;       // rays that go through the hierarchy together
constexpr float kFloatSlack = 1e-6f;  // relative: more than the rounding of a box's corner
constexpr uint32_t kNone = ~uint32_t{0};

#if RTC_VERSION_MAJOR >= 4
using QueryContext = RTCRayQueryContext;
inline void init_context(QueryContext& context) { rtcInitRayQueryContext(&context); }
#else
using QueryContext = RTCIntersectContext;
inline void init_context(QueryContext& context) { rtcInitIntersectContext(&context); }
#endif

// What the callbacks find beside the rays. Embree hands back its address.
struct Context : QueryContext {
  explicit Context(std::vector<Crossing>* found = nullptr) : crossings(found) { init_context(*this); }
  std::vector<Crossing>* crossings;  // not null: every hit is wanted, and none ends the ray
  uint32_t ray = 0;
};

void intersect(RTCScene scene, const int* valid, Context& context, RTCRayHit8& rays) {
#if RTC_VERSION_MAJOR >= 4
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &context;
  rtcIntersect8(valid, scene, &rays, &arguments);
#else
  rtcIntersect8(valid, scene, &context, &rays);
#endif
}

void occlude(RTCScene scene, const int* valid, Context& context, RTCRay8& rays) {
#if RTC_VERSION_MAJOR >= 4
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.context = &context;
  rtcOccluded8(valid, scene, &rays, &arguments);
#else
  rtcOccluded8(valid, scene, &context, &rays);
#endif
}

void occlude(RTCScene scene, Context& context, RTCRay& ray) {
#if RTC_VERSION_MAJOR >= 4
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.context = &context;
  rtcOccluded1(scene, &ray, &arguments);
#else
  rtcOccluded1(scene, &context, &ray);
#endif
}

void set(RTCRay8& rays, uint32_t k, const Ray& ray) {
  rays.org_x[k] = ray.origin.x, rays.org_y[k] = ray.origin.y, rays.org_z[k] = ray.origin.z;
  rays.dir_x[k] = ray.direction.x, rays.dir_y[k] = ray.direction.y, rays.dir_z[k] = ray.direction.z;
  rays.tnear[k] = ray.near, rays.tfar[k] = ray.far;
  rays.time[k] = 0, rays.mask[k] = kNone, rays.id[k] = k, rays.flags[k] = 0;
}

Ray ray_of(RTCRayN* rays, uint32_t n, uint32_t k) {
  return {{RTCRayN_org_x(rays, n, k), RTCRayN_org_y(rays, n, k), RTCRayN_org_z(rays, n, k)},
          RTCRayN_tnear(rays, n, k),
          {RTCRayN_dir_x(rays, n, k), RTCRayN_dir_y(rays, n, k), RTCRayN_dir_z(rays, n, k)},
          RTCRayN_tfar(rays, n, k)};
}

// Where the ray enters the body, between its near and far; NaN: nowhere.
template <class Body>
float entry(const Body& body, const Ray& ray) {
  const Chord inside = chord(body, ray);
  const bool hit = inside.in <= inside.out && inside.in >= ray.near && inside.in <= ray.far;
  return hit ? inside.in : std::numeric_limits<float>::quiet_NaN();
}

struct Box {
  Vec3f min, max;
};
void include(Box& box, const Vec3f& x, float radius) {
  box.min = {std::min(box.min.x, x.x - radius), std::min(box.min.y, x.y - radius), std::min(box.min.z, x.z - radius)};
  box.max = {std::max(box.max.x, x.x + radius), std::max(box.max.y, x.y + radius), std::max(box.max.z, x.z + radius)};
}
constexpr Box kEmptyBox{{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
void include(Box& box, const BallBody& ball) { include(box, ball.centre, ball.radius); }
void include(Box& box, const CapsuleBody& capsule) {
  include(box, capsule.a, capsule.radius);
  include(box, capsule.a + capsule.length * capsule.axis, capsule.radius);
}
void include(Box& box, const QuadBody& quad) {
  for (const Vec3f& corner : quad.corner) include(box, corner, 0);
}

class EmbreeTracer;

// The deepest body round a point, so far.
struct Containing {
  const EmbreeTracer* tracer;
  Vec3f x;
  float most = 0;
  std::optional<BodyId> deepest;

  void consider(float how_deep, const BodyId& id) {
    const bool before =
        deepest && (id.shape < deepest->shape || (id.shape == deepest->shape && id.index < deepest->index));
    if (how_deep > most || (how_deep == most && before)) most = how_deep, deepest = id;
  }
};

// The bodies of one shape, `together` by `together` one of Embree's, which takes 105 B for each of its own while it
// builds its hierarchy and 73 B then. Neighbours in the list should be neighbours in space, as particles are in the
// engine's order once it has stepped. A picture of a million balls takes 5.7 s on two threads with each for itself, 6.4
// s in twos, 9.5 s in fours.
template <class Body>
struct Grouped {
  const std::vector<Body>& bodies;
  size_t together;

  uint32_t groups() const { return static_cast<uint32_t>((bodies.size() + together - 1) / together); }
  // Calls see(body, its index) for those of a group.
  void each_of(uint32_t group, const auto& see) const {
    const size_t first = group * together, last = std::min(bodies.size(), first + together);
    for (size_t k = first; k < last; ++k) see(bodies[k], static_cast<uint32_t>(k));
  }
};

// From so many on, balls go in twos: they share the memory with a run of as many particles.
constexpr size_t kManyBalls = 4'000'000;

// The callbacks of one shape. Embree hands them the list of bodies.
template <class Body, Shape shape>
struct Bodies {
  static const Grouped<Body>& list(const void* user) { return *static_cast<const Grouped<Body>*>(user); }

  static void bounds(const RTCBoundsFunctionArguments* a) {
    Box box = kEmptyBox;
    list(a->geometryUserPtr).each_of(a->primID, [&](const Body& body, uint32_t) { include(box, body); });
    const auto slack = [](float low, float high) {
      return kFloatSlack * (std::abs(low) + std::abs(high)) + std::numeric_limits<float>::min();
    };
    const float x = slack(box.min.x, box.max.x), y = slack(box.min.y, box.max.y), z = slack(box.min.z, box.max.z);
    RTCBounds& b = *a->bounds_o;
    b.lower_x = box.min.x - x, b.lower_y = box.min.y - y, b.lower_z = box.min.z - z;
    b.upper_x = box.max.x + x, b.upper_y = box.max.y + y, b.upper_z = box.max.z + z;
  }

  static void intersected(const RTCIntersectFunctionNArguments* a) {
    RTCRayN* rays = RTCRayHitN_RayN(a->rayhit, a->N);
    RTCHitN* hits = RTCRayHitN_HitN(a->rayhit, a->N);
    for (uint32_t k = 0; k < a->N; ++k) {
      if (!a->valid[k]) continue;
      Ray ray = ray_of(rays, a->N, k);
      list(a->geometryUserPtr).each_of(a->primID, [&](const Body& body, uint32_t index) {
        const float t = entry(body, ray);
        if (std::isnan(t)) return;
        ray.far = RTCRayN_tfar(rays, a->N, k) = t;
        RTCHitN_geomID(hits, a->N, k) = static_cast<uint32_t>(shape);
        RTCHitN_primID(hits, a->N, k) = index;
      });
    }
  }

  static void occluded(const RTCOccludedFunctionNArguments* a) {
    auto* context = static_cast<Context*>(a->context);
    for (uint32_t k = 0; k < a->N; ++k) {
      if (!a->valid[k]) continue;
      const Ray ray = ray_of(a->ray, a->N, k);
      list(a->geometryUserPtr).each_of(a->primID, [&](const Body& body, uint32_t index) {
        const float t = entry(body, ray);
        if (std::isnan(t)) return;
        if (context->crossings)
          context->crossings->push_back({context->ray, {t, {shape, index}}});
        else
          RTCRayN_tfar(a->ray, a->N, k) = -std::numeric_limits<float>::infinity();
      });
    }
  }
};

class EmbreeTracer final : public RayTracer {
 public:
  EmbreeTracer(TracedBodies bodies, size_t balls_together)
      : RayTracer(std::move(bodies)), ball_groups_{balls_, balls_together}, device_(embree_device()) {
    scene_.reset(rtcNewScene(device_.get()));
    rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_COMPACT);
    attach<Shape::ball>(ball_groups_);
    attach<Shape::capsule>(capsule_groups_);
    attach<Shape::quad>(quad_groups_);
    rtcCommitScene(scene_.get());
    require_no_error(device_.get());
  }

  void closest(std::span<const Ray> rays, std::span<Hit> hits) const override {
    Context context;
    for (size_t first = 0; first < rays.size(); first += kPacket) {
      const auto count = static_cast<uint32_t>(std::min<size_t>(kPacket, rays.size() - first));
      alignas(32) int valid[kPacket] = {};
      alignas(32) RTCRayHit8 packet;
      for (uint32_t k = 0; k < kPacket; ++k) {
        valid[k] = k < count ? -1 : 0;
        set(packet.ray, k, rays[first + std::min(k, count - 1)]);
        packet.hit.geomID[k] = packet.hit.instID[0][k] = kNone;
      }
      intersect(scene_.get(), valid, context, packet);
      for (uint32_t k = 0; k < count; ++k)
        hits[first + k] = packet.hit.geomID[k] == kNone
                              ? Hit{}
                              : Hit{packet.ray.tfar[k], {Shape{packet.hit.geomID[k]}, packet.hit.primID[k]}};
    }
  }

  void any(std::span<const Ray> rays, std::span<uint8_t> blocked) const override {
    Context context;
    for (size_t first = 0; first < rays.size(); first += kPacket) {
      const auto count = static_cast<uint32_t>(std::min<size_t>(kPacket, rays.size() - first));
      alignas(32) int valid[kPacket] = {};
      alignas(32) RTCRay8 packet;
      for (uint32_t k = 0; k < kPacket; ++k) {
        valid[k] = k < count ? -1 : 0;
        set(packet, k, rays[first + std::min(k, count - 1)]);
      }
      occlude(scene_.get(), valid, context, packet);
      for (uint32_t k = 0; k < count; ++k) blocked[first + k] = packet.tfar[k] < 0;
    }
  }

  void all(std::span<const Ray> rays, std::vector<Crossing>& crossings) const override {
    Context context(&crossings);
    for (uint32_t k = 0; k < rays.size(); ++k) {
      const auto first = std::ptrdiff_t(crossings.size());
      const Ray& r = rays[k];
      RTCRay ray{};
      ray.org_x = r.origin.x, ray.org_y = r.origin.y, ray.org_z = r.origin.z;
      ray.dir_x = r.direction.x, ray.dir_y = r.direction.y, ray.dir_z = r.direction.z;
      ray.tnear = r.near, ray.tfar = r.far, ray.mask = kNone;
      context.ray = k;
      occlude(scene_.get(), context, ray);
      std::sort(crossings.begin() + first, crossings.end(), [](const Crossing& a, const Crossing& b) {
        if (a.hit.distance != b.hit.distance) return a.hit.distance < b.hit.distance;
        if (a.hit.body.shape != b.hit.body.shape) return a.hit.body.shape < b.hit.body.shape;
        return a.hit.body.index < b.hit.body.index;
      });
    }
  }

  std::optional<BodyId> containing(const Vec3f& x) const override {
    Containing query{this, x, 0, {}};
    RTCPointQuery point;
    point.x = x.x, point.y = x.y, point.z = x.z, point.time = 0, point.radius = 0;
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(scene_.get(), &point, &context, near_point, &query);
    return query.deepest;
  }

 private:
  // Returns whether the query's radius has changed: never, every body round the point is wanted.
  static bool near_point(RTCPointQueryFunctionArguments* a) {
    auto& query = *static_cast<Containing*>(a->userPtr);
    const Shape shape{a->geomID};
    const auto consider = [&](const auto& body, uint32_t index) {
      query.consider(depth(body, query.x), {shape, index});
    };
    if (shape == Shape::ball) query.tracer->ball_groups_.each_of(a->primID, consider);
    if (shape == Shape::capsule) query.tracer->capsule_groups_.each_of(a->primID, consider);
    return false;
  }

  template <Shape shape, class Body>
  void attach(const Grouped<Body>& list) {
    if (list.bodies.empty()) return;
    using Callbacks = Bodies<Body, shape>;
    const GeometryHandle geometry(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_USER));
    require_no_error(device_.get());
    rtcSetGeometryUserPrimitiveCount(geometry.get(), list.groups());
    rtcSetGeometryUserData(geometry.get(), const_cast<Grouped<Body>*>(&list));
    rtcSetGeometryBoundsFunction(geometry.get(), Callbacks::bounds, nullptr);
    rtcSetGeometryIntersectFunction(geometry.get(), Callbacks::intersected);
    rtcSetGeometryOccludedFunction(geometry.get(), Callbacks::occluded);
    rtcCommitGeometry(geometry.get());
    rtcAttachGeometryByID(scene_.get(), geometry.get(), static_cast<unsigned>(shape));
  }

  Grouped<BallBody> ball_groups_;
  Grouped<CapsuleBody> capsule_groups_{capsules_, 1};
  Grouped<QuadBody> quad_groups_{quads_, 1};
  DeviceHandle device_;
  SceneHandle scene_;
};

}  // namespace

size_t balls_together(std::span<const Ball> balls) {
  if (balls.size() < kManyBalls) return 1;
  const size_t asked = 1000, stride = balls.size() / asked;
  size_t near = 0;
  for (size_t k = 0; k < asked; ++k) {
    const Ball &a = balls[k * stride], &b = balls[k * stride + 1];
    near += norm(a.centre - b.centre) < 4 * std::max(a.radius, b.radius);
  }
  return near > asked / 2 ? 2 : 1;
}

std::unique_ptr<RayTracer> make_embree_tracer(TracedBodies bodies) {
  const size_t together = balls_together(bodies.balls);
  return make_embree_tracer(std::move(bodies), together);
}

std::unique_ptr<RayTracer> make_embree_tracer(TracedBodies bodies, size_t balls_together) {
  return std::make_unique<EmbreeTracer>(std::move(bodies), balls_together);
}

}  // namespace scree
