// What a user asks a picture to be: plain values, on the command line and in a case file alike. Lengths in m.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "geometry/vec.h"
#include "runtime/schedule.h"

namespace scree {

struct CameraRequest {
  std::string name = "front";  // runtime/render/camera.h lists them
  std::optional<Vec3> point;   // junction: look here instead of at the node nearest the lattice's centre
  // free:
  std::optional<Vec3> position, target;
  Vec3 up{0, 0, 1};
  double field_of_view_deg = 30;  // from the lower to the upper edge; not with width
  double width = 0;               // m; > 0: orthographic
};

struct ValueRange {
  double min, max;
};

enum class WallStyle { transparent, faint, hidden };

struct PictureSize {
  int width = 1920, height = 1080;
};

inline constexpr int kDefaultSamples = 8;

struct PictureRequest {
  CameraRequest camera;
  std::string colour = "speed";     // a quantity (runtime/render/quantity.h)
  std::optional<ValueRange> range;  // of the colours; not given: from the values
  std::vector<std::string> cuts;    // as parse_cut() reads them (runtime/render/picture.h)
  WallStyle walls = WallStyle::transparent;
  PictureSize size;
  int samples = kDefaultSamples;
  bool annotations = true;
};

// [[output.picture]]: a picture that a run draws of itself.
struct RunPicture {
  std::string name;  // of its files: pictures/NAME_TIME.png
  PictureRequest request;
  Moments moments;
};

}  // namespace scree
