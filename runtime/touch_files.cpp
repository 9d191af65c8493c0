#include "runtime/touch_files.h"

#include "runtime/touch_numbers.h"

namespace scree {

void write_touch(const std::filesystem::path& out, const Case&, const TouchSurface& surface,
                 const TouchRecord& record) {
  write_touch_csv(out / "touch.csv", surface, record);
}

}  // namespace scree
