// Folders and whole VTKHDF files among the results: a file is there complete or not at all. Throw RunError.
#pragma once

#include <functional>

#include "runtime/vtkhdf_file.h"

namespace scree {

void make_folder(const std::filesystem::path& folder);
void write_vtkhdf(const std::filesystem::path& path, VtkHdfType type, const std::function<void(VtkHdfFile&)>& fill);

}  // namespace scree
