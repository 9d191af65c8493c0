#include "runtime/case_writer.h"

#include <fmt/format.h>

#include <stdexcept>

namespace scree {

std::string write_case(const Case& understood) {
  if (understood.understood.empty()) throw std::invalid_argument("write_case: this case was not made by read_case()");
  return fmt::format(
      "# The case as it was understood: bases and overrides merged, defaults filled in.\n# Read from {}\n\n{}",
      understood.source, understood.understood);
}

}  // namespace scree
