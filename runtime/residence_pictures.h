// FOLDER/times.png, the histogram of residence times by mass, and FOLDER/retained.png, the lattice's junctions from the
// front (x-z) and from the side (y-z), coloured by what is left at them, summed along the line of sight. Makes the
// folder if there is something to draw. `entered`: kg, what the bins' mass is a part of. Throws RunError.
#pragma once

#include <filesystem>

#include "runtime/residence.h"

namespace scree {

void write_residence_pictures(const std::filesystem::path& folder, const Case& c, const std::vector<ResidenceBin>& bins,
                              const std::vector<Retained>& retained, double entered);

}  // namespace scree
