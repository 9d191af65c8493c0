#include "runtime/render/renderer.h"

#include "kernels/parallel.h"
#include "runtime/render/tile_painter.h"

namespace scree {

Image render(Scene scene, const Camera& camera, const PictureSize& size, int samples) {
  const TilePainter painter(std::move(scene), camera, size, samples);
  Image image(size.width, size.height);
  const size_t columns = (size.width + kTile - 1) / kTile, rows = (size.height + kTile - 1) / kTile;
  parallel_for(columns * rows, [&](size_t k) {
    painter.paint(image, static_cast<int>(k % columns) * kTile, static_cast<int>(k / columns) * kTile);
  });
  return image;
}

}  // namespace scree
