#include "runtime/render/tile_mask.h"

#include <algorithm>
#include <cmath>

namespace scree {

TileMask::TileMask(const Camera& camera, const PictureSize& size, int tile)
    : camera_(camera),
      size_(size),
      tile_(tile),
      columns_((size.width + tile - 1) / tile),
      rows_((size.height + tile - 1) / tile),
      all_(camera.distance > 0),
      marked_(size_t(columns_) * rows_) {}

void TileMask::mark(const Vec3& a, const Vec3& b, double radius) {
  if (all_) return;
  const Projected p = project(camera_, a), q = project(camera_, b);
  const double r = radius / camera_.height * size_.height + 1;  // pixels, with one for rounding
  const auto tile_of = [&](double pixel, int count) {
    return static_cast<int>(std::clamp(std::floor(pixel / tile_), -1.0, static_cast<double>(count)));
  };
  const auto x = [&](double heights) { return 0.5 * size_.width + heights * size_.height; };
  const int x0 = std::max(0, tile_of(x(std::min(p.x, q.x)) - r, columns_));
  const int x1 = std::min(columns_ - 1, tile_of(x(std::max(p.x, q.x)) + r, columns_));
  const int y0 = std::max(0, tile_of(std::min(p.y, q.y) * size_.height - r, rows_));
  const int y1 = std::min(rows_ - 1, tile_of(std::max(p.y, q.y) * size_.height + r, rows_));
  for (int row = y0; row <= y1; ++row)
    for (int column = x0; column <= x1; ++column) marked_[size_t(row) * columns_ + column] = 1;
}

void TileMask::add(const Capsule& capsule) {
  const Vec3 edge = capsule.axis.b - capsule.axis.a;
  const double tiles = norm(edge) / camera_.height * size_.height / tile_;
  const int pieces = std::clamp(static_cast<int>(tiles), 1, 1000);
  for (int k = 0; k < pieces; ++k)
    mark(capsule.axis.a + (double(k) / pieces) * edge, capsule.axis.a + (double(k + 1) / pieces) * edge,
         capsule.radius);
}

void TileMask::add(const Quad& quad) {
  // The box in the picture, not in the world: walls lie across the axes of a slanting camera.
  double right[2] = {INFINITY, -INFINITY}, up[2] = {INFINITY, -INFINITY};
  for (const Vec3& c : quad.corners) {
    const Vec3 d = c - camera_.target;
    const double x = dot(d, camera_.right), y = dot(d, camera_.up);
    right[0] = std::min(right[0], x), right[1] = std::max(right[1], x);
    up[0] = std::min(up[0], y), up[1] = std::max(up[1], y);
  }
  const auto corner = [&](int k) { return camera_.target + right[k] * camera_.right + up[k] * camera_.up; };
  mark(corner(0), corner(1), 0);
}

}  // namespace scree
