// Instantiates the kernels of one lane set for every choice; included once per instruction set.
#pragma once

#include "kernels/chunk_step.h"
#include "kernels/step_kernels.h"

namespace scree {

template <class L, RollingModel rolling>
StepKernels<typename L::Real> kernels_for(bool uniform) {
  return {uniform ? &step_chunk<L, PassTraits<rolling, true>> : &step_chunk<L, PassTraits<rolling, false>>,
          &search_chunk<L>};
}

template <class L>
StepKernels<typename L::Real> kernels_for(const KernelChoice& choice) {
  switch (choice.rolling) {
    case RollingModel::none:
      return kernels_for<L, RollingModel::none>(choice.uniform);
    case RollingModel::cdt:
      return kernels_for<L, RollingModel::cdt>(choice.uniform);
    default:
      return kernels_for<L, RollingModel::epsd2>(choice.uniform);
  }
}

StepKernels<float> native_kernels(const KernelChoice& choice);
StepKernels<float> avx512_kernels(const KernelChoice& choice);  // only on machines that have it
StepKernels<float> scalar_kernels(const KernelChoice& choice);
StepKernels<double> reference_kernels(const KernelChoice& choice);

}  // namespace scree
