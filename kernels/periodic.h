// Periodic axes. A pair of neighbours is never further apart than half a period along an axis, so the nearest image is
// the one that touches.
#pragma once

#include "geometry/vec.h"

namespace scree {

// d + the multiple of each period (m; 0: not periodic) that makes it shortest. Exactly odd in d.
template <class D>
inline Vec<D> minimum_image(const Vec<D>& d, const double* period) {
  const auto wrap = [](const D& a, double length) {
    return length > 0 ? fma(round(a * D(1 / length)), D(-length), a) : a;
  };
  return {wrap(d.x, period[0]), wrap(d.y, period[1]), wrap(d.z, period[2])};
}

}  // namespace scree
