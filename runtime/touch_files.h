// Touch maps as files: OUT/touch.csv, OUT/touch/surface.vtkhdf (UnstructuredGrid) and OUT/touch/*.png. Throws RunError.
#pragma once

#include "runtime/touch_maps.h"

namespace scree {

void write_touch(const std::filesystem::path& out, const Case& c, const TouchSurface& surface,
                 const TouchRecord& record);

}  // namespace scree
