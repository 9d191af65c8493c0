// The case as it was understood: bases and overrides merged in, defaults filled in, as TOML that read_case() reads to
// the same Case. Files that the case names are written with their full path.
#pragma once

#include <string>

#include "runtime/case.h"

namespace scree {

// `understood` must come from read_case().
std::string write_case(const Case& understood);

}  // namespace scree
