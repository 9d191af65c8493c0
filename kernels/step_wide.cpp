// The kernels of the wide set. CMakeLists.txt compiles this file for x86-64-v4 and keeps what it instantiates
// to itself: no other part of the program may end up with a copy of an inline function that needs AVX-512.
#include "kernels/step_table.h"

namespace scree {
static_assert(HWY_NAMESPACE::kWidth == 16);
StepKernels<float> wide_kernels(const KernelChoice& choice) { return kernels_for<HWY_NAMESPACE::NativeLanes>(choice); }
}  // namespace scree
