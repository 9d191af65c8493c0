// Touch maps as files: OUT/touch.csv (runtime/touch_numbers.h), OUT/touch/surface.vtkhdf and OUT/touch/*.png. Makes the
// folder. Throws RunError.
#pragma once

#include "runtime/touch_maps.h"

namespace scree {

void write_touch(const std::filesystem::path& out, const Case& c, const TouchSurface& surface,
                 const TouchRecord& record);

// The exposed cells as quadrilaterals (UnstructuredGrid) with what is counted on them as cell data.
void write_touch_vtkhdf(const std::filesystem::path& path, const Case& c, const TouchSurface& surface,
                        const TouchRecord& record);
// Unrolled maps: of fibres alike, of every fibre, of each wall's faces.
void write_touch_pictures(const std::filesystem::path& folder, const Case& c, const TouchSurface& surface,
                          const TouchRecord& record);

}  // namespace scree
