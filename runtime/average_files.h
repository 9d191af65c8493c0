// Averaged fields as files: FOLDER/NAME.vtkhdf and FOLDER/NAME_QUANTITY.png, slices through the middle of the box
// across x and across y. Makes the folder. Throws RunError.
//
// The file is ImageData with a point in the middle of each cell: VTK 9.1 reads cell data of images as if there were as
// many cells as points, and fails. A field's sum over the points times the product of the spacings is its integral.
// The attribute KernelHalfWidth (m) is that of Lucy's kernel (kernels/coarse_grain.h).
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
