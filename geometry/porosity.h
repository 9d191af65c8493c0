// Porosity of a section filled with fibres: the share of the box that the union of the capsules leaves free. What lies
// outside the box does not count, so fibres on its faces count by half.
//
// The box is pierced by columns along its longest edge. Along a column the union is exact: each capsule is convex, so
// it covers one interval, and intervals are merged. Across, 2^18 columns of a fixed low-discrepancy sequence are
// averaged: measured within 1e-5 of 2^24 columns for the Octet lattice, and within 1e-4 of the circle's area for one
// fibre along the columns, the roughest case. With the columns fixed, the answer is the same on every run and falls
// monotonically with the diameter, so that solving for the diameter is well posed.
#pragma once

#include <span>

#include "geometry/octet_lattice.h"

namespace scree {

// axes: the fibres' centre lines; diameter in m, >= 0; box of positive volume. Throws std::invalid_argument.
double porosity(std::span<const Segment> axes, double diameter, const Bounds& box);

// The diameter in m, to 1e-6 relative, at which porosity() returns `target`. Throws std::invalid_argument with the
// reachable range unless porosity(box's longest edge) <= target < 1.
double fibre_diameter_for_porosity(std::span<const Segment> axes, const Bounds& box, double target);

// The same for a whole lattice section, at the cost of an eighth of one cell whatever the number of cells: every
// cell holds the same solid (a fibre of a neighbour reaches in nowhere that its own mirror image does not), and a cell
// is its own mirror image in the three coordinates.
double porosity(const OctetLattice& lattice, double diameter);
double fibre_diameter_for_porosity(const OctetLattice& lattice, double target);

}  // namespace scree
