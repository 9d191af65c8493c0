// What averaged fields say about fibre junctions: grains stagnate above them and leave voids below.
#pragma once

#include <nlohmann/json.hpp>

#include "runtime/averages.h"

namespace scree {

// Means, over the junctions of fibres (runtime/junctions.h) inside the grid, of the fields on a line one grain diameter
// long that begins where the upward (downward) vertical leaves the room that fibres leave to a grain's centre: just
// above and just below. Null without junctions.
nlohmann::json junction_summary(const Case& c, const CoarseGrid& grid, const AverageFields& fields);

}  // namespace scree
