// Periodic axes. A pair of neighbours is never further apart than half a period along an axis, so the nearest image is
// the one that touches.
#pragma once

#include "geometry/vec.h"

namespace scree {

// d + the multiple of each period (m; 0, and its inverse 0: not periodic) that makes it shortest. Exactly odd in d.
template <class D>
[[gnu::always_inline]] inline Vec<D> minimum_image(const Vec<D>& d, const double* period,
                                                   const double* inverse_period) {
  const auto wrap = [&](const D& a, int axis) { return fma(round(a * D(inverse_period[axis])), D(-period[axis]), a); };
  return {wrap(d.x, 0), wrap(d.y, 1), wrap(d.z, 2)};
}

}  // namespace scree
