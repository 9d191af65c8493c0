// What is written on a picture: the colours' meaning, a length, the time.
#pragma once

#include <optional>
#include <string>

#include "runtime/render/camera.h"
#include "runtime/render/colour_map.h"

namespace scree {

// A length to show, and how long it is in the picture.
struct ScaleBar {
  double length = 0;  // m: round, a tenth to a quarter of the picture's width
  int pixels = 0;
  std::string label;  // "5 mm"
};
ScaleBar scale_bar(const Camera& camera, int width, int height);

struct Annotations {
  std::optional<ColourScale> colours;
  std::optional<ScaleBar> scale;
  std::string title;
  double time = 0;  // s; NaN: not shown
};

// Lays them over the picture, in sizes that suit it.
void annotate(Image& image, const Annotations& annotations);

}  // namespace scree
