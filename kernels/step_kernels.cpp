#include "kernels/step_kernels.h"

#include <stdexcept>

#include "kernels/self_check.h"
#include "kernels/simd.h"
#include "kernels/step_table.h"

namespace scree {

namespace {
#if defined(SCREE_WIDE)
// Few machines that build this have it: it is trusted only where it gives the bits of the other sets.
bool has_wide_set() {
  static const bool trusted = machine_has_wide_set() && agrees_with_scalar(wide_kernels({}), {});
  return trusted;
}
#endif
}  // namespace

std::vector<std::string> available_isas() {
  std::vector<std::string> names{kNativeSet, kScalarSet};
#if defined(SCREE_WIDE)
  if (has_wide_set()) names.insert(names.begin(), kWideSet);
#endif
  return names;
}

template <>
StepKernels<float> select_kernels<float>(const std::string& isa, const KernelChoice& choice) {
#if defined(SCREE_WIDE)
  if (isa == kWideSet && has_wide_set()) return wide_kernels(choice);
#endif
  if (isa == kNativeSet) return native_kernels(choice);
  if (isa == kScalarSet) return scalar_kernels(choice);
  std::string known;
  for (const std::string& name : available_isas()) known += " " + name;
  throw std::invalid_argument("instruction set '" + isa + "' is not available; this machine and build have:" + known);
}

template <>
StepKernels<double> select_kernels<double>(const std::string&, const KernelChoice& choice) {
  return reference_kernels(choice);
}

}  // namespace scree
