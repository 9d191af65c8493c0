// Fibres from a CSV file: the axes and, if the file says them, the diameters. Columns in any order:
//     x0, y0, z0, x1, y1, z1   m, the ends of the axis
//     diameter                 m, optional
#pragma once

#include <string>
#include <vector>

#include "geometry/closest_point.h"
#include "runtime/case_table.h"

namespace scree {

inline constexpr Range kFibreDiameter{1e-7, 10, "m", false};
inline constexpr double kShortestFibre = 1e-9;  // m, of the axis: what is shorter has no direction

struct Fibre {
  Segment axis;
  double diameter = 0;  // m; 0: not said
};

// Throws CaseError with file, line and column.
std::vector<Fibre> read_fibres_csv(const std::string& path);
std::vector<Fibre> read_fibres_csv(const std::string& path, std::string text);  // with its text at hand

}  // namespace scree
