#include "runtime/render/camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/bounds.h"
#include "runtime/render/known_name.h"

namespace scree {

namespace {

constexpr double kMargin = 1.08;             // of what is framed, so that it does not touch the picture's edge
constexpr double kJunctionFieldOfView = 25;  // degrees
constexpr double kJunctionElevation = 12;    // degrees above the horizon: the void below a node stays in sight

double radians(double degrees) { return degrees * std::numbers::pi / 180; }

Camera looking(const Vec3& forward, const Vec3& up) {
  Camera camera;
  camera.forward = unit(forward);
  camera.right = unit(cross(camera.forward, up));
  camera.up = cross(camera.right, camera.forward);
  return camera;
}

// The whole region, orthographic, as large as it fits.
Camera framed(Camera camera, const Bounds& region, double aspect) {
  const Vec3 size = region.max - region.min;
  const auto extent = [&](const Vec3& axis) {
    return std::abs(axis.x) * size.x + std::abs(axis.y) * size.y + std::abs(axis.z) * size.z;
  };
  camera.target = 0.5 * (region.min + region.max);
  camera.height = kMargin * std::max(extent(camera.up), extent(camera.right) / aspect);
  return camera;
}

double distance_for(double height, double field_of_view_deg) {
  return 0.5 * height / std::tan(0.5 * radians(field_of_view_deg));
}

Camera junction_camera(const CameraRequest& request, const CameraSubject& subject, double aspect) {
  const std::optional<Vec3> point = request.point ? request.point : subject.junction;
  if (!point)
    throw CaseError({"camera 'junction'"},
                    "the case has no fibres that meet, so there is no junction to look at: give a point, or use "
                    "another camera");
  const double elevation = radians(kJunctionElevation);
  Camera camera = looking({0.25, std::cos(elevation), -std::sin(elevation)}, {0, 0, 1});
  camera.target = *point;
  camera.height = subject.junction_size / std::min(1.0, aspect);
  camera.distance = distance_for(camera.height, kJunctionFieldOfView);
  return camera;
}

Camera free_camera(const CameraRequest& request, double aspect) {
  if (!request.position || !request.target) throw CaseError({"camera 'free'"}, "needs a position and a target, m");
  const Vec3 line = *request.target - *request.position;
  const double distance = norm(line);
  if (!(distance > 0) || !(norm(cross(line, request.up)) > 1e-9 * distance * norm(request.up)))
    throw CaseError({"camera 'free'"},
                    "position and target must differ, and the line between them must not be along `up`");
  Camera camera = looking(line, request.up);
  camera.target = *request.target;
  if (request.width > 0) {
    camera.height = request.width / aspect;
  } else {
    camera.distance = distance;
    camera.height = 2 * distance * std::tan(0.5 * radians(request.field_of_view_deg));
  }
  return camera;
}

}  // namespace

const std::vector<std::string>& camera_names() {
  static const std::vector<std::string> names{"front", "side", "top", "junction", "free"};
  return names;
}

Camera make_camera(const CameraRequest& request, const CameraSubject& subject, double aspect) {
  if (request.name == "front") return framed(looking({0, 1, 0}, {0, 0, 1}), subject.region, aspect);
  if (request.name == "side") return framed(looking({1, 0, 0}, {0, 0, 1}), subject.region, aspect);
  if (request.name == "top") return framed(looking({0, 0, -1}, {0, 1, 0}), subject.region, aspect);
  if (request.name == "junction") return junction_camera(request, subject, aspect);
  if (request.name == "free") return free_camera(request, aspect);
  fail_unknown_name("--camera", "camera", request.name, camera_names());
}

Projected project(const Camera& camera, const Vec3& x) {
  const Vec3 d = x - camera.target;
  const double scale = camera.distance > 0 ? camera.distance / (camera.distance + dot(d, camera.forward)) : 1;
  return {scale * dot(d, camera.right) / camera.height, 0.5 - scale * dot(d, camera.up) / camera.height};
}

}  // namespace scree
