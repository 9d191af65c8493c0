// Which tiles of an orthographic picture something may be seen in, so that no ray is cast into the others.
#pragma once

#include <vector>

#include "runtime/render/camera.h"
#include "runtime/render/scene.h"

namespace scree {

class TileMask {
 public:
  // Nothing is marked yet. A perspective picture is all marked.
  TileMask(const Camera& camera, const PictureSize& size, int tile);

  void add(const Ball& ball) { mark(ball.centre, ball.centre, ball.radius); }
  void add(const Capsule& capsule);  // along its length: a slanting one marks few tiles beside it
  void add(const Quad& quad);

  bool at(int x0, int y0) const { return all_ || marked_[(y0 / tile_) * columns_ + x0 / tile_]; }

 private:
  void mark(const Vec3& a, const Vec3& b, double radius);  // the tiles that the box of both, widened, covers

  Camera camera_;
  PictureSize size_;
  int tile_, columns_, rows_;
  bool all_;
  std::vector<uint8_t> marked_;
};

}  // namespace scree
