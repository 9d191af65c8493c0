// Whether two cases are the same run.
#pragma once

#include <optional>
#include <string>

namespace scree {

// The first key that differs between two cases as they were understood (Case::understood), as a sentence; nothing if
// they run to the same bits. Comments, the order of keys, and keys that do not change a run's course (title,
// output.final_vtk, [[output.picture]], [checkpoint]) do not count.
std::optional<std::string> case_difference(const std::string& before, const std::string& now);

}  // namespace scree
