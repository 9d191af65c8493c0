// What particles can be coloured by, and which colours that gives.
#pragma once

#include <optional>

#include "runtime/case.h"
#include "runtime/render/colour_map.h"
#include "runtime/render/particle_frame.h"
#include "runtime/render/picture_request.h"

namespace scree {

// Every name that values_of() knows for this frame: speed, coordination, kind, age, force, ..., components of vectors
// as force_x; of a stress its pressure (trace / 3, positive where it presses together: the sign of the files) and its
// components as contact_stress_xy.
std::vector<std::string> quantities_of(const ParticleFrame& frame);

// The field that a quantity is of; null for a diameter and an unknown name.
const ParticleField* field_of(const ParticleFrame& frame, const std::string& quantity);

// One value for each particle, SI: a vector's length, a stress's pressure; not a number where it is not known. Throws
// std::invalid_argument for an unknown name, listing the known.
std::vector<double> values_of(const ParticleFrame& frame, const std::string& quantity);

// The colours for these values: from zero to a round number that one value in a hundred exceeds, symmetric about zero
// if some are negative, or the values' own range if they are all alike; `given` instead, if it is. Kinds have their
// names from the case.
ColourScale colour_scale(const Case& c, const std::string& quantity, std::vector<double> values,
                         const std::optional<ValueRange>& given = {});

}  // namespace scree
