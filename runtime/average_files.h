// Averaged fields as files: FOLDER/NAME.vtkhdf (ImageData, one value a cell) and FOLDER/NAME_QUANTITY.png, slices
// through the middle of the box across x and across y. Makes the folder. Throws RunError.
#pragma once

#include <filesystem>

#include "runtime/averages.h"

namespace scree {

void write_average(const std::filesystem::path& folder, const std::string& name, const Case& c, const CoarseGrid& grid,
                   const AverageFields& fields);

// One of the two.
void write_average_vtkhdf(const std::filesystem::path& path, const CoarseGrid& grid, const AverageFields& fields);
void write_average_pictures(const std::filesystem::path& folder, const std::string& name, const Case& c,
                            const CoarseGrid& grid, const AverageFields& fields);

}  // namespace scree
