// Whether kernels do on this machine what the scalar ones do.
#pragma once

#include "kernels/step_kernels.h"

namespace scree {

// Steps a small heap of touching particles by both; true if every bit of the result is the same. A millisecond.
bool agrees_with_scalar(const StepKernels<float>& kernels, const KernelChoice& choice);

}  // namespace scree
