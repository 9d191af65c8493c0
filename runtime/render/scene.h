// What a picture shows. World coordinates, m.
#pragma once

#include <vector>

#include "geometry/ray_tracer.h"
#include "runtime/render/image.h"
#include "runtime/render/picture_request.h"

namespace scree {

// Cuts away the half-space normal . x > offset; what the plane cuts through shows a flat face.
struct CutPlane {
  Vec3 normal;  // unit
  double offset;
};

struct Scene {
  std::vector<Ball> balls;
  std::vector<Srgb> ball_colours;   // one for each ball
  std::vector<Capsule> fibres;      // metal
  std::vector<Quad> walls;          // glass, whatever they are made of
  std::vector<Segment> wall_edges;  // drawn as lines
  WallStyle wall_style = WallStyle::transparent;
  std::vector<CutPlane> cuts;
};

inline constexpr Rgb kBackground{0.965f, 0.965f, 0.965f};

}  // namespace scree
