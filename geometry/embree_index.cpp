// Primitives are registered as user geometry, because Embree 3.13's rtcPointQuery never calls back for curves.
//
// Embree works in float, the answer is in double. Embree only proposes: bounds and query sphere are widened by more
// than float rounding can take away, so that it proposes too many, and the exact distance decides.
#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/argument.h"
#include "geometry/bounds.h"
#include "geometry/closest_point.h"
#include "geometry/embree.h"
#include "geometry/solid_index.h"

namespace scree {

namespace {

// A conversion to float and the few sums of a box-sphere test are each off by at most half this, relative.
constexpr double kFloatSlack = 8.0 * std::numeric_limits<float>::epsilon();
// Keeps Embree's squares of lengths within float. Queries beyond it are answered without Embree.
constexpr double kLargestLength = 1e15;  // m

double largest_coordinate(const Vec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

// The smallest normal float on top, so that nothing is widened by zero.
double widened(double length, double magnitude) {
  return length + kFloatSlack * (magnitude + length) + std::numeric_limits<float>::min();
}

RTCBounds float_bounds(const Bounds& bounds) {
  const double magnitude = std::max(largest_coordinate(bounds.min), largest_coordinate(bounds.max));
  const Bounds wide = inflated(bounds, widened(0, magnitude));
  RTCBounds result{};
  result.lower_x = float(wide.min.x), result.lower_y = float(wide.min.y), result.lower_z = float(wide.min.z);
  result.upper_x = float(wide.max.x), result.upper_y = float(wide.max.y), result.upper_z = float(wide.max.z);
  return result;
}

struct Query {
  const std::vector<PreparedPrimitive>& primitives;
  Vec3 x;
  double reach;
  std::vector<uint32_t>& found;

  void consider(uint32_t primitive) {
    if (distance(primitives[primitive], x) <= reach) found.push_back(primitive);
  }
};

class EmbreeIndex final : public SolidIndex {
 public:
  explicit EmbreeIndex(const Solid& solid) : device_(embree_device()) {
    for (const Primitive& primitive : solid.primitives) add(primitive);
    centre_ = primitives_.empty() ? Vec3{0, 0, 0} : 0.5 * (bounds_of(solid).min + bounds_of(solid).max);
    for (Bounds& bounds : bounds_) bounds = {bounds.min - centre_, bounds.max - centre_};
    build();
  }

  void query(const Vec3& x, double reach, std::vector<uint32_t>& found) const override {
    const auto first = std::ptrdiff_t(found.size());
    Query query{primitives_, x, reach, found};
    const Vec3 local = x - centre_;
    const double magnitude = std::max(largest_coordinate(local), std::abs(reach));
    if (magnitude < kLargestLength) {
      // A negative reach finds points deep inside, which are inside the bounds as well.
      ask_embree(local, widened(std::max(reach, 0.0), magnitude), query);
      std::sort(found.begin() + first, found.end());
    } else {
      for (uint32_t k = 0; k < primitives_.size(); ++k) query.consider(k);
    }
  }

 private:
  void add(const Primitive& primitive) {
    primitives_.push_back(prepared(primitive));
    const Bounds bounds = bounds_of(primitive);
    const double magnitude = std::max(largest_coordinate(bounds.min), largest_coordinate(bounds.max));
    require(magnitude < kLargestLength, fmt::format("largest coordinate of primitive {}", primitives_.size() - 1),
            magnitude, "m", fmt::format("below {:g} m", kLargestLength));
    bounds_.push_back(bounds);
  }

  void build() {
    scene_.reset(rtcNewScene(device_.get()));
    const GeometryHandle geometry(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_USER));
    require_no_error(device_.get());
    rtcSetGeometryUserPrimitiveCount(geometry.get(), unsigned(primitives_.size()));
    rtcSetGeometryUserData(geometry.get(), this);
    rtcSetGeometryBoundsFunction(geometry.get(), bounds_callback, this);
    rtcSetGeometryPointQueryFunction(geometry.get(), query_callback);
    rtcCommitGeometry(geometry.get());
    rtcAttachGeometry(scene_.get(), geometry.get());
    rtcCommitScene(scene_.get());
    require_no_error(device_.get());
  }

  void ask_embree(const Vec3& local, double radius, Query& query) const {
    RTCPointQuery sphere;  // set by name: the order in memory is x, y, z, time, radius
    sphere.x = float(local.x);
    sphere.y = float(local.y);
    sphere.z = float(local.z);
    sphere.time = 0;
    sphere.radius = float(radius);
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(scene_.get(), &sphere, &context, nullptr, &query);
  }

  static void bounds_callback(const RTCBoundsFunctionArguments* arguments) {
    const auto* index = static_cast<const EmbreeIndex*>(arguments->geometryUserPtr);
    *arguments->bounds_o = float_bounds(index->bounds_[arguments->primID]);
  }

  // Returns whether the query's radius has changed: never, every primitive in reach is wanted.
  static bool query_callback(RTCPointQueryFunctionArguments* arguments) {
    static_cast<Query*>(arguments->userPtr)->consider(arguments->primID);
    return false;
  }

  std::vector<PreparedPrimitive> primitives_;
  std::vector<Bounds> bounds_;  // from centre_
  Vec3 centre_;                 // Embree's origin: near it floats are finest
  DeviceHandle device_;
  SceneHandle scene_;
};

}  // namespace

std::unique_ptr<SolidIndex> make_embree_index(const Solid& solid) { return std::make_unique<EmbreeIndex>(solid); }

}  // namespace scree
