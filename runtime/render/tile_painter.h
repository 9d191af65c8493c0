// A small square of a picture: rays from the eye, what they hit, and the light there. All rays of a tile that ask the
// same question go through the tracer together.
#pragma once

#include <memory>

#include "runtime/render/renderer.h"
#include "runtime/render/tile_mask.h"

namespace scree {

inline constexpr int kTile = 16;  // pixels: its rays and hits stay in a core's cache

class TilePainter {
 public:
  TilePainter(Scene scene, const Camera& camera, const PictureSize& size, int samples);

  // Paints the tile whose upper left pixel is (x0, y0). Thread-safe for different tiles.
  void paint(Image& image, int x0, int y0) const;

 private:
  struct Cut {  // keeps normal . x <= offset, local
    Vec3f normal;
    float offset;
  };
  struct Surface {  // what a sample's ray meets first
    Vec3f point, normal, view;
    Rgb colour;
    float shine;
    bool is_fibre;
    uint32_t sample;
  };
  struct Tile;

  void cast(Tile& tile) const;
  void find_surfaces(Tile& tile) const;
  void light(Tile& tile) const;
  void lay_walls_over(Tile& tile) const;

  Ray eye_ray(double x, double y) const;              // through a point of the picture, pixels
  bool clip(Ray& ray, const Cut*& entered_by) const;  // to what the cuts leave; false: nothing is left
  void leave(Ray& ray) const;                         // from a point that is left: ends where it meets a cut
  Surface surface_at(const Ray& ray, const BodyId& body, float distance) const;

  std::vector<Srgb> ball_colours_;
  WallStyle wall_style_;
  Camera camera_;
  PictureSize size_;
  int samples_;
  std::unique_ptr<RayTracer> solid_, glass_;      // glass_: walls and their edges; null: none is drawn
  Vec3f eye_, step_right_, step_down_, forward_;  // local to solid_; steps of a pixel on the plane through the target
  Vec3f to_light_, light_u_, light_v_, sky_;
  Vec3f glass_shift_;  // from solid_'s coordinates to glass_'s
  std::vector<Cut> cuts_;
  TileMask solid_tiles_, glass_tiles_;
  float reach_ = 0;  // m: how far the light from all round looks for what keeps it out
  float start_ = 0;  // m: shadow rays begin this far off the surface
};

}  // namespace scree
