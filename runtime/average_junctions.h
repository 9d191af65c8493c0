// What averaged fields say about fibre junctions: grains stagnate above them and leave voids below.
#pragma once

#include <nlohmann/json.hpp>

#include "runtime/averages.h"

namespace scree {

// Means, over the junctions of fibres (runtime/junctions.h) inside the grid, of the fields on a line one grain diameter
// long that begins where the upward (downward) vertical leaves the room that fibres leave to a grain's centre: just
// above and just below. Null without junctions.
//
//   solid_fraction                 of all space, as the field has it: beside a fibre the fibre's volume counts
//   solid_fraction_of_free_space   over what fibres leave free, seen through the same kernel
//   speed_m_per_s, downward_velocity_m_per_s
//   speed_over_section_mean        over the mean speed, by mass, in the lattice's section: section_mean_speed_m_per_s
nlohmann::json junction_summary(const Case& c, const CoarseGrid& grid, const AverageFields& fields);

}  // namespace scree
