// What averaged fields say about lanes: where in each layer of the grid grains run down the fastest, and how much
// faster than on the whole.
#pragma once

#include <nlohmann/json.hpp>

#include "runtime/averages.h"

namespace scree {

// A layer of the grid, across z, through which mass goes down.
struct Lane {
  double z = 0;               // m, the layer's middle
  double peak_over_mean = 0;  // largest downward mass flux over the layer's mean in the space that fibres leave free
  double x = 0, y = 0;        // m, where it is largest: the middle of that cell
  double from_axis = 0;       // m, from the vertical through the middle of the grid
};
// Of the layers between the heights from and to. A mean needs free space and a flow downwards: others are left out.
std::vector<Lane> lanes_of(const CoarseGrid& grid, const AverageFields& fields, double from, double to);

// Those of the lattice's section, or of the whole grid without one, as lists, with their means and extremes. Null where
// nothing flows down.
nlohmann::json lane_summary(const Case& c, const CoarseGrid& grid, const AverageFields& fields);

}  // namespace scree
