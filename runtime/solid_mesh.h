// Fibres and walls as a surface of triangles and quadrilaterals: what field files show.
#pragma once

#include "geometry/solid.h"
#include "runtime/vtkhdf_file.h"

namespace scree {

// The surface of a solid, with a value per cell of what it belongs to. Round parts are chords: a fibre has 16 sides (8
// if there are more than 10,000 fibres) and round ends, a surface of revolution 64.
struct SolidMesh {
  VtkGrid grid;
  std::vector<int32_t> wall;       // index into Solid::walls
  std::vector<int32_t> primitive;  // index into Solid::primitives
  std::vector<float> radius;       // m: a fibre's; 0 for walls
};

SolidMesh mesh_of(const Solid& solid);
void write_mesh(VtkHdfFile& file, const SolidMesh& mesh);

}  // namespace scree
