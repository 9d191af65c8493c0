// The junctions of a network of fibres: the points where their axes end, each once.
#pragma once

#include <numbers>
#include <optional>
#include <unordered_map>
#include <vector>

#include "geometry/solid.h"

namespace scree {

class Junctions {
 public:
  // Ends closer than a thousandth of the typical fibre are one. reach() is the median axis / sqrt(2): in an Octet
  // lattice half a cell's edge, within which every point of the lattice has a junction.
  explicit Junctions(const Solid& solid);

  const std::vector<Vec3>& points() const { return points_; }  // in the order of the fibres
  double reach() const { return reach_; }                      // m; 0 without fibres
  // m: nearer to a junction than to the middle of a fibre, a quarter of the median axis.
  double near() const { return reach_ * kNearOfReach; }
  std::optional<size_t> nearest(const Vec3& x) const;  // within reach()

 private:
  static constexpr double kNearOfReach = std::numbers::sqrt2 / 4;
  struct Cell {
    int64_t x, y, z;
    bool operator==(const Cell&) const = default;
  };
  struct Hash {
    size_t operator()(const Cell& c) const {
      return static_cast<size_t>(c.x * 73856093 ^ c.y * 19349663 ^ c.z * 83492791);
    }
  };
  Cell cell_of(const Vec3& x) const;
  std::optional<size_t> nearest_within(const Vec3& x, double reach) const;

  double reach_ = 0;
  std::vector<Vec3> points_;
  std::unordered_map<Cell, std::vector<size_t>, Hash> cells_;  // of edge reach_
};

}  // namespace scree
