// The kernels of one instruction set, chosen once at start.
#pragma once

#include <string>
#include <vector>

#include "kernels/chunk_task.h"
#include "kernels/neighbour_search.h"

namespace scree {

template <class Real>
struct StepKernels {
  ChunkOutcome (*step)(const ChunkTask<Real>&);
  void (*search)(const SearchTask<Real>&);
};

struct KernelChoice {
  RollingModel rolling = RollingModel::epsd2;
  bool uniform = true;  // one row of material constants for all pairs, one for all walls
  bool ledger = false;  // ChunkOutcome::ledger is wanted
};

// Names of the instruction sets this build has and this machine can run, best first: "avx512", "avx2" or "neon",
// "scalar".
std::vector<std::string> available_isas();

// `isa` is one of available_isas(); throws std::invalid_argument otherwise. The double kernels are scalar.
template <class Real>
StepKernels<Real> select_kernels(const std::string& isa, const KernelChoice& choice);
template <>
StepKernels<float> select_kernels(const std::string& isa, const KernelChoice& choice);
template <>
StepKernels<double> select_kernels(const std::string& isa, const KernelChoice& choice);

}  // namespace scree
