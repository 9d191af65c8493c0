#include "geometry/octet_lattice.h"

#include <algorithm>

#include "geometry/argument.h"
#include "geometry/fuzzing.h"
#include "geometry/walls.h"

namespace scree {

namespace {

// About 24 fibres a cell; more than this is a slip of the pen, and would not fit beside the particles.
constexpr double kMostCells = kFuzzing ? 30 : 1e6;

using HalfCells = std::array<int, 3>;  // a position counted in half cells

// The half of the 12 neighbours that come later in the order of the nodes, in that order.
constexpr HalfCells kLaterNeighbours[] = {{-1, 1, 0}, {1, 1, 0}, {0, -1, 1}, {-1, 0, 1}, {1, 0, 1}, {0, 1, 1}};

// Points of the half-cell grid, x fastest; every second one is a node.
class HalfCellGrid {
 public:
  explicit HalfCellGrid(const std::array<int, 3>& cells) : last_{2 * cells[0], 2 * cells[1], 2 * cells[2]} {}

  // Calls visit(position) for each node in order.
  template <class Visit>
  void for_each_node(const Visit& visit) const {
    for (int k = 0; k <= last_[2]; ++k)
      for (int j = 0; j <= last_[1]; ++j)
        for (int i = (j + k) % 2; i <= last_[0]; i += 2) visit(HalfCells{i, j, k});
  }

  bool holds(const HalfCells& p) const {
    return std::ranges::all_of(std::array{0, 1, 2}, [&](int d) { return p[d] >= 0 && p[d] <= last_[d]; });
  }

  // Rows and layers have odd numbers of points, so counting all points, nodes are exactly the even ones.
  uint32_t node_index(const HalfCells& p) const {
    const auto nx = uint64_t(last_[0]) + 1, ny = uint64_t(last_[1]) + 1;
    return uint32_t(((uint64_t(p[2]) * ny + uint64_t(p[1])) * nx + uint64_t(p[0])) / 2);
  }

 private:
  HalfCells last_;
};

void check(double cell_size, const std::array<int, 3>& cells) {
  require_positive("cell_size", cell_size);
  const char* names[] = {"cells[0]", "cells[1]", "cells[2]"};
  for (int d = 0; d < 3; ++d) require(cells[d] >= 1, names[d], cells[d], "cells", "at least 1");
  const double count = double(cells[0]) * cells[1] * cells[2];
  require(count <= kMostCells, "number of cells", count, "cells", fmt::format("in [1, {:g}]", kMostCells));
}

}  // namespace

OctetLattice octet_lattice(double cell_size, std::array<int, 3> cells, const Vec3& origin) {
  check(cell_size, cells);
  OctetLattice lattice{cell_size, cells, origin, {}, {}};
  const HalfCellGrid grid(cells);
  grid.for_each_node([&](const HalfCells& p) {
    lattice.nodes.push_back(origin + (0.5 * cell_size) * Vec3{double(p[0]), double(p[1]), double(p[2])});
    for (const HalfCells& step : kLaterNeighbours) {
      const HalfCells q{p[0] + step[0], p[1] + step[1], p[2] + step[2]};
      if (grid.holds(q)) lattice.fibres.push_back({grid.node_index(p), grid.node_index(q)});
    }
  });
  return lattice;
}

Bounds section_of(const OctetLattice& lattice) {
  const auto& n = lattice.cells;
  return {lattice.origin, lattice.origin + lattice.cell_size * Vec3{double(n[0]), double(n[1]), double(n[2])}};
}

std::vector<Segment> fibre_axes(const OctetLattice& lattice) {
  std::vector<Segment> axes;
  axes.reserve(lattice.fibres.size());
  for (const auto& [first, second] : lattice.fibres) axes.push_back({lattice.nodes[first], lattice.nodes[second]});
  return axes;
}

std::vector<Primitive> fibre_primitives(const OctetLattice& lattice, double diameter, const SurfaceLabel& label) {
  require(diameter > 0 && diameter < lattice.cell_size, "fibre diameter", diameter, "m",
          fmt::format("in (0, {:g}) m, the cell size", lattice.cell_size));
  return fibre_network(fibre_axes(lattice), diameter, label);
}

}  // namespace scree
