// Draws a scene by tracing rays: one key light with soft shadows, light from all round that creases keep out, several
// samples a pixel. The sample pattern is fixed, so a picture is the same every time and for every number of threads.
#pragma once

#include "runtime/render/camera.h"
#include "runtime/render/scene.h"

namespace scree {

// 1 <= samples <= 64 a pixel. Throws std::invalid_argument for a body that cannot be drawn (geometry/ray_tracer.h).
Image render(Scene scene, const Camera& camera, const PictureSize& size, int samples = kDefaultSamples);

}  // namespace scree
