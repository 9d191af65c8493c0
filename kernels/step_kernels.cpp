#include "kernels/step_kernels.h"

#include <stdexcept>

#include "kernels/self_check.h"
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
#if defined(SCREE_AVX512)
bool has_avx512() {
  __builtin_cpu_init();
  const bool has = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                   __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                   __builtin_cpu_supports("avx512vl");
  // Few machines that build this have it: trust it only where it gives the bits of the other sets.
  static const bool trusted = has && agrees_with_scalar(avx512_kernels({}), {});
  return trusted;
}
#endif

}  // namespace

std::vector<std::string> available_isas() {
  std::vector<std::string> names{kNative, "scalar"};
#if defined(SCREE_AVX512)
  if (has_avx512()) names.insert(names.begin(), "avx512");
#endif
  return names;
}

template <>
StepKernels<float> select_kernels<float>(const std::string& isa, const KernelChoice& choice) {
#if defined(SCREE_AVX512)
  if (isa == "avx512" && has_avx512()) return avx512_kernels(choice);
#endif
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
