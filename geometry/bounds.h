// Axis-aligned bounds, m. All tight: the smallest box that holds the surface.
#pragma once

#include "geometry/solid.h"

namespace scree {

// Holds nothing: min = +inf, max = -inf. The neutral element of united().
Bounds empty_bounds();

Bounds bounds_of(const Primitive& primitive);
Bounds bounds_of(const Solid& solid);  // empty_bounds() for an empty solid

Bounds united(const Bounds& a, const Bounds& b);
Bounds inflated(const Bounds& bounds, double margin);  // moves all six faces out by `margin`
bool contains(const Bounds& bounds, const Vec3& x);    // faces belong to the box
double volume_of(const Bounds& bounds);                // m3

}  // namespace scree
