// How much of a box a union of equal capsules fills, by exact integration along columns. Used by geometry/porosity.h.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/solid.h"

namespace scree {

class CapsuleColumns {
 public:
  // Keeps copies. The columns run along the box's longest edge.
  CapsuleColumns(std::span<const Segment> axes, double radius, const Bounds& box);

  // Volume of (union of capsules, clipped to the box) / volume of the box.
  double solid_fraction() const;

  struct Interval {
    double begin, end;  // along the column; empty if begin >= end
  };

 private:
  // A capsule in coordinates turned so that columns run along z.
  struct Capsule {
    Vec3 a, b, direction;  // direction: unit, or zero for a fibre without length (a sphere)
    double length;
  };

  void make_bins();
  void add_to_bins(uint32_t capsule);
  std::vector<uint32_t>& bin(int i, int j) { return bins_[size_t(j) * bins_x_ + i]; }
  int bin_x(double x) const;
  int bin_y(double y) const;
  Interval covered(const Capsule& capsule, double x, double y) const;
  double covered_length(double x, double y, std::vector<Interval>& scratch) const;

  double radius_;
  Bounds box_;  // turned
  std::vector<Capsule> capsules_;
  int bins_x_, bins_y_;
  double bin_width_x_, bin_width_y_;
  std::vector<std::vector<uint32_t>> bins_;  // capsules that a column in the bin may meet
};

}  // namespace scree
