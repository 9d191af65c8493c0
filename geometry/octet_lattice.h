// The Octet lattice: cubic cells of side a with nodes on the 8 corners and 6 face centres, and a fibre between every
// two nodes of a cell at distance a/sqrt(2). Nodes and fibres that cells share exist once. Lengths in m.
//
//     o-------o     Counted in half cells, the nodes are the points (i, j, k) with i + j + k even: a face-centred
//     | \ o / |     cubic lattice. A node's fibres lead to its 12 nearest neighbours, two coordinates differing by one.
//     | o   o |     So one rule makes a lattice of any size without looking for duplicates.
//     | / o \ |     5 x 1 x 10 cells: 1,460 fibres.
//     o-------o
//
// Source: Kaur, Aider, Cho, Singh, J. Solar Energy Eng. (2023), doi 10.1115/1.4064018.
#pragma once

#include <array>
#include <vector>

#include "geometry/solid.h"

namespace scree {

struct OctetLattice {
  double cell_size = 0;                         // m
  std::array<int, 3> cells{};                   // along x, y, z
  Vec3 origin{};                                // the corner with the smallest coordinates
  std::vector<Vec3> nodes;                      // by k, then j, then i
  std::vector<std::array<uint32_t, 2>> fibres;  // pairs of nodes, first < second, ascending
};

// Throws std::invalid_argument unless cell_size > 0 and there are 1 to 10^6 cells.
OctetLattice octet_lattice(double cell_size, std::array<int, 3> cells, const Vec3& origin);

// The lattice section: whole cells. Fibres on its faces are half outside.
Bounds section_of(const OctetLattice& lattice);

std::vector<Segment> fibre_axes(const OctetLattice& lattice);

// One capsule per fibre, in the order of the fibres. Throws std::invalid_argument unless 0 < diameter < cell_size.
std::vector<Primitive> fibre_primitives(const OctetLattice& lattice, double diameter, const SurfaceLabel& label);

}  // namespace scree
