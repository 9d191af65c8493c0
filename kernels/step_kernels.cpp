#include "kernels/step_kernels.h"

#include <stdexcept>

#include "kernels/step_table.h"

namespace scree {

namespace {
#if defined(__x86_64__)
constexpr const char* kNative = "avx2";
#elif defined(__aarch64__)
constexpr const char* kNative = "neon";
#else
constexpr const char* kNative = "native";
#endif
}  // namespace

std::vector<std::string> available_isas() { return {kNative, "scalar"}; }

template <>
StepKernels<float> select_kernels<float>(const std::string& isa, const KernelChoice& choice) {
  if (isa == kNative) return native_kernels(choice);
  if (isa == "scalar") return scalar_kernels(choice);
  std::string known;
  for (const std::string& name : available_isas()) known += " " + name;
  throw std::invalid_argument("instruction set '" + isa + "' is not available; this machine and build have:" + known);
}

template <>
StepKernels<double> select_kernels<double>(const std::string&, const KernelChoice& choice) {
  return reference_kernels(choice);
}

}  // namespace scree
