#include "geometry/octet_lattice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "geometry/bounds.h"

namespace scree {
namespace {

TEST(OctetLattice, HasTheFibresOfItsCellsOnce) {
  EXPECT_EQ(octet_lattice(0.01, {1, 1, 1}, {0, 0, 0}).fibres.size(), 36u);
  EXPECT_EQ(octet_lattice(0.01, {1, 1, 1}, {0, 0, 0}).nodes.size(), 14u);
  EXPECT_EQ(octet_lattice(0.01, {1, 1, 3}, {0, 0, 0}).fibres.size(), 100u);
  EXPECT_EQ(octet_lattice(0.01, {5, 1, 10}, {0, 0, 0}).fibres.size(), 1460u);
}

// The rule as the paper words it: per cell, every pair of its 14 nodes at distance a/sqrt(2); duplicates dropped.
TEST(OctetLattice, IsTheUnionOfItsCellsAsDefined) {
  using Point = std::array<int, 3>;  // half cells
  std::set<std::pair<Point, Point>> expected;
  for (int cz = 0; cz < 4; ++cz)
    for (int cy = 0; cy < 2; ++cy)
      for (int cx = 0; cx < 3; ++cx) {
        std::vector<Point> nodes;
        for (int c = 0; c < 8; ++c) nodes.push_back({2 * (c & 1), c & 2, (c & 4) / 2});
        for (int d = 0; d < 3; ++d)
          for (int side : {0, 2}) {
            Point p{1, 1, 1};
            p[d] = side;
            nodes.push_back(p);
          }
        for (const Point& p : nodes)
          for (const Point& q : nodes) {
            const int dx = p[0] - q[0], dy = p[1] - q[1], dz = p[2] - q[2];
            const Point a{p[0] + 2 * cx, p[1] + 2 * cy, p[2] + 2 * cz}, b{q[0] + 2 * cx, q[1] + 2 * cy, q[2] + 2 * cz};
            if (dx * dx + dy * dy + dz * dz == 2 && a < b) expected.insert({a, b});
          }
      }

  std::set<std::pair<Point, Point>> made;
  const OctetLattice lattice = octet_lattice(2, {3, 2, 4}, {0, 0, 0});  // half a cell is 1 m
  const auto rounded = [](const Vec3& v) {
    return Point{int(std::lround(v.x)), int(std::lround(v.y)), int(std::lround(v.z))};
  };
  for (const Segment& axis : fibre_axes(lattice)) {
    EXPECT_NEAR(norm(axis.b - axis.a), std::sqrt(2.0), 1e-15);
    made.insert(std::minmax(rounded(axis.a), rounded(axis.b)));
  }
  EXPECT_EQ(made.size(), lattice.fibres.size());
  EXPECT_EQ(made, expected);
}

TEST(OctetLattice, InteriorNodesJoinTwelveFibres) {
  const OctetLattice lattice = octet_lattice(0.01, {3, 2, 4}, {0.5, -0.25, 0.125});
  std::vector<int> valence(lattice.nodes.size());
  for (const auto& [a, b] : lattice.fibres) ++valence[a], ++valence[b];
  const Bounds interior = inflated(section_of(lattice), -0.001);
  int interior_nodes = 0;
  for (size_t k = 0; k < lattice.nodes.size(); ++k) {
    if (!contains(interior, lattice.nodes[k])) {
      EXPECT_LT(valence[k], 12);
      continue;
    }
    ++interior_nodes;
    EXPECT_EQ(valence[k], 12);
  }
  EXPECT_EQ(interior_nodes, 52);  // even i + j + k with 1 <= i <= 5, 1 <= j <= 3, 1 <= k <= 7
}

TEST(OctetLattice, FillsItsSectionFromTheOrigin) {
  const OctetLattice lattice = octet_lattice(0.01, {5, 1, 10}, {-0.025, -0.005, 0});
  const Bounds section = section_of(lattice);
  EXPECT_NEAR(norm(section.max - Vec3{0.025, 0.005, 0.1}), 0, 1e-15);
  Bounds nodes = empty_bounds();
  for (const Vec3& node : lattice.nodes) nodes = united(nodes, {node, node});
  EXPECT_NEAR(norm(nodes.min - section.min), 0, 1e-15);
  EXPECT_NEAR(norm(nodes.max - section.max), 0, 1e-15);
}

TEST(OctetLattice, ListsFibresInAscendingOrder) {
  const OctetLattice lattice = octet_lattice(0.01, {3, 2, 2}, {0, 0, 0});
  EXPECT_TRUE(std::is_sorted(lattice.fibres.begin(), lattice.fibres.end()));
  for (const auto& [a, b] : lattice.fibres) EXPECT_LT(a, b);
}

TEST(OctetLattice, FibresBecomeCapsules) {
  const OctetLattice lattice = octet_lattice(0.01, {1, 1, 3}, {0, 0, 0});
  const std::vector<Primitive> fibres = fibre_primitives(lattice, 1.55e-3, {3, 4});
  ASSERT_EQ(fibres.size(), 100u);
  EXPECT_EQ(fibres[7].radius, 0.5 * 1.55e-3);
  EXPECT_EQ(fibres[7].material, 3u);
  EXPECT_EQ(fibres[7].wall, 4u);
  EXPECT_EQ(norm(std::get<Segment>(fibres[7].skeleton).a - lattice.nodes[lattice.fibres[7][0]]), 0);
}

TEST(OctetLattice, RefusesImpossibleArguments) {
  EXPECT_THROW(octet_lattice(0, {1, 1, 1}, {0, 0, 0}), std::invalid_argument);
  EXPECT_THROW(octet_lattice(0.01, {1, 0, 1}, {0, 0, 0}), std::invalid_argument);
  EXPECT_THROW(octet_lattice(0.01, {10000, 10000, 10000}, {0, 0, 0}), std::invalid_argument);
  EXPECT_THROW(fibre_primitives(octet_lattice(0.01, {1, 1, 1}, {0, 0, 0}), 0.01, {}), std::invalid_argument);
}

}  // namespace
}  // namespace scree
