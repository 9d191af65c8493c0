#include "kernels/cell_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

namespace scree {
namespace {

using Cell = std::array<uint32_t, 3>;
constexpr double kOpen[3] = {0, 0, 0};
constexpr size_t kPlenty = 1u << 24;

// Cells along each axis, found from the outside: the cell of the far corner.
Cell shape_of(const CellGrid& grid, const Bounds& box) {
  Cell n = grid.cell_of(box.max + 1e-9 * (box.max - box.min));
  for (uint32_t& c : n) ++c;
  return n;
}

template <class Visit>
void for_each_cell(const Cell& n, const Visit& visit) {
  for (uint32_t z = 0; z < n[2]; ++z)
    for (uint32_t y = 0; y < n[1]; ++y)
      for (uint32_t x = 0; x < n[0]; ++x) visit(Cell{x, y, z});
}

void expect_codes_unique(const CellGrid& grid, const Cell& n) {
  ASSERT_EQ(size_t{n[0]} * n[1] * n[2], grid.size());
  ASSERT_EQ(grid.ranges.size(), grid.size());
  std::vector<uint32_t> codes;
  std::vector<bool> linear(grid.size());
  for_each_cell(n, [&](const Cell& c) {
    codes.push_back(grid.morton(c));
    ASSERT_LT(grid.linear(c), grid.size());
    EXPECT_FALSE(linear[grid.linear(c)]);
    linear[grid.linear(c)] = true;
  });
  std::ranges::sort(codes);
  EXPECT_TRUE(std::ranges::adjacent_find(codes) == codes.end());
  EXPECT_LT(uint64_t{codes.back()}, uint64_t{1} << grid.morton_bits());
}

TEST(CellGrid, CodesAreUniqueInEveryShape) {
  for (const Vec3& size :
       {Vec3{10, 10, 10}, Vec3{1, 1, 1}, Vec3{33, 1, 1}, Vec3{1, 100, 3}, Vec3{7, 64, 65}, Vec3{0.5, 0.5, 200}}) {
    const Bounds box{{-3, 5, 0.25}, Vec3{-3, 5, 0.25} + size};
    CellGrid grid;
    grid.lay(box, kOpen, 1, kPlenty);
    expect_codes_unique(grid, shape_of(grid, box));
    const double period[3] = {size.x, 0, size.z};
    grid.lay(box, period, 1, kPlenty);
    expect_codes_unique(grid, shape_of(grid, box));
  }
}

TEST(CellGrid, OfACubeIsInMortonOrder) {
  CellGrid grid;
  grid.lay({{0, 0, 0}, {3.5, 3.5, 3.5}}, kOpen, 1, kPlenty);
  for_each_cell({4, 4, 4}, [&](const Cell& c) {
    uint32_t code = 0;
    for (int bit = 0; bit < 2; ++bit)
      for (int a = 0; a < 3; ++a) code |= (c[a] >> bit & 1u) << (3 * bit + a);
    EXPECT_EQ(grid.morton(c), code);
  });
}

TEST(CellGrid, OfFlatBoxesAndOfOnePointHasOneLayerOrOneCell) {
  CellGrid grid;
  grid.lay({{1, 2, 3}, {1, 2, 3}}, kOpen, 0.1, kPlenty);
  EXPECT_EQ(grid.size(), 1u);
  EXPECT_EQ(grid.morton_bits(), 0);
  EXPECT_EQ(grid.morton(grid.cell_of({1, 2, 3})), 0u);
  grid.lay({{0, 0, 5}, {1, 1, 5}}, kOpen, 0.3, kPlenty);
  EXPECT_EQ(grid.size(), 16u);
  expect_codes_unique(grid, {4, 4, 1});
}

TEST(CellGrid, ClampsPositionsOutsideToTheBorderCells) {
  CellGrid grid;
  grid.lay({{0, 0, 0}, {4.5, 4.5, 4.5}}, kOpen, 1, kPlenty);
  EXPECT_EQ(grid.cell_of({-9, 2.5, 99}), (Cell{0, 2, 4}));
  EXPECT_EQ(grid.cell_of({-1e-300, 0, 4.5}), (Cell{0, 0, 4}));
  EXPECT_EQ(grid.cell_of({1e30, -1e30, 1e300}), (Cell{4, 0, 4}));
}

TEST(CellGrid, NeverMakesCellsNarrowerThanAskedNorMoreThanAllowed) {
  std::mt19937 random(1);
  const auto between = [&](double low, double high) { return low + (high - low) * (random() / 4294967296.0); };
  for (int k = 0; k < 300; ++k) {
    const Bounds box{{0, 0, 0}, {between(0.1, 30), between(0.1, 30), between(0.1, 30)}};
    const double period[3] = {k % 2 ? box.max.x : 0, k % 3 ? box.max.y : 0, k % 5 ? box.max.z : 0};
    const size_t most = 1 + random() % 20000;
    CellGrid grid;
    grid.lay(box, period, 1, most);
    ASSERT_LE(grid.size(), most);
    // Two points less than one width apart along each axis are in the same or in neighbouring cells.
    for (int point = 0; point < 100; ++point) {
      const Vec3 a{between(0, box.max.x), between(0, box.max.y), between(0, box.max.z)};
      const Vec3 b = a + Vec3{between(0, 1), between(0, 1), between(0, 1)};
      const Cell ca = grid.cell_of(a), cb = grid.cell_of(b);
      for (int axis = 0; axis < 3; ++axis) ASSERT_LE(cb[axis] - ca[axis], 1u);
    }
  }
}

TEST(CellGrid, OfAHugeEmptyBoxStaysSmall) {
  CellGrid grid;
  grid.lay({{-1e6, -1e6, -1e6}, {1e6, 1e6, 1e6}}, kOpen, 1e-3, 4096);
  EXPECT_LE(grid.size(), 4096u);
  EXPECT_GT(grid.size(), 1000u);
  grid.lay({{0, 0, 0}, {1e9, 0, 0}}, kOpen, 1e-3, kPlenty);  // a line
  EXPECT_LE(grid.size(), 65536u);
}

// Across a periodic border the shift takes the other cell's positions to where the neighbour looks for them.
TEST(CellGrid, NeighboursWrapAlongPeriodicAxesOnly) {
  const Bounds box{{-1, -2, -3}, {4, 3, 2}};
  const double period[3] = {5, 0, 5};
  CellGrid grid;
  grid.lay(box, period, 0.9, kPlenty);
  const Cell n = shape_of(grid, box);
  ASSERT_EQ(n, (Cell{5, 6, 5}));
  size_t found = 0;
  for_each_cell(n, [&](const Cell& c) {
    for (int dz = -1; dz <= 1; ++dz)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
          Cell other;
          Vec3 shift;
          const bool inside = static_cast<int>(c[1]) + dy >= 0 && static_cast<int>(c[1]) + dy < static_cast<int>(n[1]);
          ASSERT_EQ(grid.neighbour(c, {dx, dy, dz}, other, shift), inside);
          if (!inside) continue;
          ++found;
          const int offset[3] = {dx, dy, dz};
          const double moved[3] = {shift.x, shift.y, shift.z};
          for (int a = 0; a < 3; ++a) {
            // Unwrapped, the other cell stands one cell beside this one.
            const double cells_moved = period[a] > 0 ? moved[a] / period[a] * n[a] : 0;
            EXPECT_EQ(static_cast<double>(other[a]) + cells_moved, static_cast<double>(c[a]) + offset[a]);
          }
        }
  });
  EXPECT_EQ(found, 5 * 5 * 9 * (6 * 3 - 2u));
}

TEST(CellGrid, WithOneOrTwoPeriodicCellsStillShowsEveryImage) {
  for (const double length : {1.5, 2.5}) {
    const double period[3] = {length, 0, 0};
    CellGrid grid;
    grid.lay({{0, 0, 0}, {length, 0, 0}}, period, 1, kPlenty);
    std::set<std::pair<uint32_t, double>> images;
    for (int dx = -1; dx <= 1; ++dx) {
      Cell other;
      Vec3 shift;
      ASSERT_TRUE(grid.neighbour({0, 0, 0}, {dx, 0, 0}, other, shift));
      images.emplace(other[0], shift.x);
    }
    EXPECT_EQ(images.size(), 3u);
  }
}

}  // namespace
}  // namespace scree
