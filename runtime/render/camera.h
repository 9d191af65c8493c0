// Where a picture is seen from. Lengths in m, z up in the named cameras.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "geometry/solid.h"

namespace scree {

// Sees `height` m from the lower to the upper edge of the picture at the target: everywhere if orthographic, else at
// the target's distance. forward, right and up are unit vectors at right angles.
struct Camera {
  Vec3 target{}, forward{0, 1, 0}, right{1, 0, 0}, up{0, 0, 1};
  double height = 1;
  double distance = 0;  // from the eye to the target; 0: orthographic
};

// The names, in the order they are listed in messages.
const std::vector<std::string>& camera_names();

// What a user asks for.
struct CameraRequest {
  std::string name = "front";
  std::optional<Vec3> point;  // junction: look here instead of at the node nearest the lattice's centre
  // free:
  std::optional<Vec3> position, target;
  Vec3 up{0, 0, 1};
  double field_of_view_deg = 30;  // from the lower to the upper edge; not with width
  double width = 0;               // m; > 0: orthographic
};

struct CameraSubject {
  Bounds region{};               // what front, side and top frame
  std::optional<Vec3> junction;  // the node nearest the lattice's centre
  double junction_size = 0;      // m, of what is round it: a few fibres
};

// Throws CaseError for an unknown name (listing the known), a free camera without position or target, or one that looks
// along `up`, a junction without fibres. `aspect` is the picture's width / height.
Camera make_camera(const CameraRequest& request, const CameraSubject& subject, double aspect);

// World to picture: x to the right and y down, in picture heights from the upper left corner of the square picture
// whose left edge is the centre line: the centre is (0, 0.5). For scale bars, labels and tests.
struct Projected {
  double x, y;
};
Projected project(const Camera& camera, const Vec3& x);

}  // namespace scree
