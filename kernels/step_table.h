// Instantiates the kernels of one lane set for every choice; included once per instruction set.
#pragma once

#include "kernels/chunk_step.h"
#include "kernels/step_kernels.h"

namespace scree {

template <class L, RollingModel rolling>
StepKernels<typename L::Real> kernels_of(const KernelChoice& choice) {
  if (choice.ledger) return {&step_chunk<L, PassTraits<rolling, false, true>>, &search_chunk<L>};
  if (choice.uniform) return {&step_chunk<L, PassTraits<rolling, true>>, &search_chunk<L>};
  return {&step_chunk<L, PassTraits<rolling, false>>, &search_chunk<L>};
}

template <class L>
StepKernels<typename L::Real> kernels_for(const KernelChoice& choice) {
  switch (choice.rolling) {
    case RollingModel::none:
      return kernels_of<L, RollingModel::none>(choice);
    case RollingModel::cdt:
      return kernels_of<L, RollingModel::cdt>(choice);
    default:
      return kernels_of<L, RollingModel::epsd2>(choice);
  }
}

StepKernels<float> native_kernels(const KernelChoice& choice);
StepKernels<float> wide_kernels(const KernelChoice& choice);  // only on machines that have the wide set
StepKernels<float> scalar_kernels(const KernelChoice& choice);
StepKernels<double> reference_kernels(const KernelChoice& choice);

}  // namespace scree
