// The kernels for the instruction set that the whole program requires: AVX2 on x86-64, NEON on 64-bit Arm.
#include "kernels/step_table.h"

namespace scree {
StepKernels<float> native_kernels(const KernelChoice& choice) {
  return kernels_for<HWY_NAMESPACE::NativeLanes>(choice);
}
}  // namespace scree
