// One lane: the float path that the SIMD paths must equal bit for bit, and the double reference.
#include "kernels/step_table.h"

namespace scree {
StepKernels<float> scalar_kernels(const KernelChoice& choice) { return kernels_for<ScalarLanes<float>>(choice); }
StepKernels<double> reference_kernels(const KernelChoice& choice) { return kernels_for<ScalarLanes<double>>(choice); }
}  // namespace scree
