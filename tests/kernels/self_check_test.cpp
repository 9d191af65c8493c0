#include "kernels/self_check.h"

#include <gtest/gtest.h>

namespace scree {
namespace {

const KernelChoice kEpsd2{RollingModel::epsd2, true};

TEST(SelfCheck, every_instruction_set_of_this_machine_agrees_with_scalar) {
  for (const RollingModel rolling : {RollingModel::none, RollingModel::cdt, RollingModel::epsd2})
    for (const bool uniform : {true, false})
      for (const std::string& isa : available_isas())
        EXPECT_TRUE(agrees_with_scalar(select_kernels<float>(isa, {rolling, uniform}), {rolling, uniform})) << isa;
}

TEST(SelfCheck, sees_kernels_of_another_law) {
  const StepKernels<float> other = select_kernels<float>("scalar", {RollingModel::cdt, true});
  EXPECT_FALSE(agrees_with_scalar(other, kEpsd2));
}

}  // namespace
}  // namespace scree
