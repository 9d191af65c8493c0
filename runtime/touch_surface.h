// The surface of fibres and plane walls, cut into cells on which touches are counted.
#pragma once

#include <cstdint>
#include <numbers>
#include <vector>

#include "runtime/case.h"

namespace scree {

// A fibre's side, or a plane face of a wall in the rectangle round it. Cells are counted across first, then along.
//
//   fibre: `along` is its axis, upwards; the angle round it counts from `top`, the side that looks up, towards
//          cross(along, top). Column 0 begins at the angle 0. Its round ends belong to no cell.
//   face:  `along` is the direction in the face that leads up, `across` the one at a right angle.
struct TouchPatch {
  uint32_t primitive = 0;  // index into Case::solid
  bool fibre = false;
  Vec3 origin{};                     // m, a fibre's lower end, a face's corner
  Vec3 along{}, across{}, normal{};  // unit vectors; a fibre: axis, cross(along, top), top
  double radius = 0;                 // m, of a fibre
  double length = 0, width = 0;      // m, along and across; a fibre's circumference
  uint32_t rows = 0, columns = 0;    // cells along, across
  size_t first = 0;                  // its cells are first ... first + rows * columns - 1

  size_t cells() const { return size_t(rows) * columns; }
  double cell_area() const { return length * width / static_cast<double>(cells()); }
  Vec3 at(double s, double across_share) const;  // m; on a fibre across_share = angle / 2 pi
  Vec3 outward(double across_share) const;       // unit
  double angle(uint32_t column) const {          // of a fibre's column, its middle, 0 to 2 pi; 0: top
    return 2 * std::numbers::pi * (column + 0.5) / columns;
  }
};

enum class TouchState : uint8_t {
  hidden,        // inside a fibre, beyond a wall, or outside the face: no surface
  out_of_reach,  // surface that the smallest grain has no room to touch
  open
};

class TouchSurface {
 public:
  static constexpr size_t kNone = ~size_t{0};

  explicit TouchSurface(const Case& c);

  const std::vector<TouchPatch>& patches() const { return patches_; }
  const std::vector<TouchState>& states() const { return states_; }  // one a cell, of its middle
  size_t size() const { return states_.size(); }
  bool is_mapped(size_t primitive) const { return patch_of_[primitive] != kNoPatch; }
  // The cell that holds a point of the primitive's surface; kNone if it has none there.
  size_t cell_of(size_t primitive, const Vec3& point) const;

 private:
  static constexpr uint32_t kNoPatch = ~uint32_t{0};
  void look_what_is_open(const Case& c);
  std::vector<TouchPatch> patches_;
  std::vector<uint32_t> patch_of_;  // by primitive
  std::vector<TouchState> states_;
  Vec3 period_{}, inverse_period_{};  // m, 1/m; 0 along axes that are not periodic
};

bool is_opened(const Case& c, uint32_t wall);  // by a stage
bool is_mapped_face(const Primitive& p, const TouchSettings& touch);
double area_of_rectangle_round(const Quad& face);  // m2
double cells_of_touch(const Case& c);
inline constexpr double kBytesPerTouchCell = 200;  // with what is written at the end

}  // namespace scree
