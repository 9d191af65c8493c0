// The grid of an average, from its settings.
#pragma once

#include "kernels/coarse_grain.h"
#include "runtime/case.h"

namespace scree {

// Whole cells that fill the box, edges as near to the spacing as that allows. It wraps along a periodic axis whose
// period the box covers.
CoarseGrid grid_of(const AverageSettings& average, const Case& c);

double memory_of_average(const AverageSettings& average);  // bytes, while the run goes on and its files are written
// While it looks, of so many particles at most: it takes them some at a time.
inline constexpr double kAverageBytesPerParticle = 240, kAverageParticlesAtOnce = 6e5;

}  // namespace scree
