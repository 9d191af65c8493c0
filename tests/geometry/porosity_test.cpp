#include "geometry/porosity.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <numbers>

#include "geometry/bounds.h"
#include "tests/geometry/random_geometry.h"

namespace scree {
namespace {

const Bounds kUnitBox{{0, 0, 0}, {1, 1, 1}};

// The share of one random point in each of n^3 voxels that no capsule holds: independent of columns and intervals.
double voxel_porosity(const std::vector<Segment>& axes, double diameter, const Bounds& box, int n) {
  RandomGeometry random(21);
  std::vector<SegmentOf<double>> skeletons;
  for (const Segment& axis : axes) skeletons.push_back(prepared(axis));
  const Vec3 size = (1.0 / n) * (box.max - box.min);
  const auto free = [&](const Vec3& x) {
    for (const auto& skeleton : skeletons)
      if (norm(x - closest_on(skeleton, x)) < 0.5 * diameter) return false;
    return true;
  };
  int64_t count = 0;
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const Vec3 low = box.min + Vec3{i * size.x, j * size.y, k * size.z};
        count += free(random.in_box({low, low + size}));
      }
  return double(count) / (double(n) * n * n);
}

OctetLattice paper_lattice() { return octet_lattice(0.01, {5, 1, 10}, {-0.025, -0.005, 0}); }

// Kaur et al. 2023, doi 10.1115/1.4064018: the three lattices of the paper, whose diameters and porosities are given to
// two decimals. Each true porosity lies within that rounding; 1.00 mm - 0.88 only just (1.00 mm makes 0.886).
TEST(Porosity, OfThePapersLatticesRoundsToThePapers) {
  const struct { double diameter, porosity; } rows[] = {{1.55e-3, 0.75}, {1.36e-3, 0.80}, {1.00e-3, 0.88}};
  for (const auto& row : rows) {
    const double found = porosity(paper_lattice(), row.diameter);
    RecordProperty(fmt::format("porosity_at_{:.2f}_mm", 1e3 * row.diameter), fmt::format("{:.6f}", found));
    EXPECT_GT(porosity(paper_lattice(), row.diameter - 0.005e-3), row.porosity - 0.005) << row.diameter;
    EXPECT_LT(porosity(paper_lattice(), row.diameter + 0.005e-3), row.porosity + 0.005) << row.diameter;
  }
}

TEST(Porosity, OfOneCellAgreesWithThreeMillionVoxels) {
  const std::vector<Segment> axes = fibre_axes(octet_lattice(0.01, {1, 1, 1}, {0, 0, 0}));
  for (const double diameter : {1.00e-3, 1.55e-3}) {
    const double voxels = voxel_porosity(axes, diameter, {{0, 0, 0}, {0.005, 0.005, 0.005}}, 150);
    EXPECT_NEAR(porosity(paper_lattice(), diameter), voxels, 2e-4);
  }
}

TEST(Porosity, OfTheWholeSectionIsThatOfOneCell) {
  const OctetLattice lattice = paper_lattice();
  for (const double diameter : {1.0e-3, 1.55e-3, 3.0e-3})
    EXPECT_NEAR(porosity(fibre_axes(lattice), diameter, section_of(lattice)), porosity(lattice, diameter), 5e-5);
}

TEST(Porosity, OfARandomNetworkAgreesWithVoxels) {
  RandomGeometry random(22);
  std::vector<Segment> axes;
  for (int k = 0; k < 8; ++k) axes.push_back({random.in_cube(1.2), random.in_cube(1.2)});
  const Bounds box{{-1, -0.8, -0.7}, {0.9, 1, 0.6}};
  EXPECT_NEAR(porosity(axes, 0.4, box), voxel_porosity(axes, 0.4, box, 150), 2e-4);
}

TEST(Porosity, OfOneFibreThroughTheBoxIsThatOfItsCircleAlongEachAxis) {
  const double exact = 1 - std::numbers::pi * 0.2 * 0.2;
  EXPECT_NEAR(porosity(std::vector{Segment{{-1, 0.5, 0.5}, {2, 0.5, 0.5}}}, 0.4, kUnitBox), exact, 2e-5);
  EXPECT_NEAR(porosity(std::vector{Segment{{0.5, -1, 0.5}, {0.5, 2, 0.5}}}, 0.4, kUnitBox), exact, 2e-5);
  EXPECT_NEAR(porosity(std::vector{Segment{{0.5, 0.5, -1}, {0.5, 0.5, 2}}}, 0.4, kUnitBox), exact, 2e-5);
}

TEST(Porosity, CountsAFibreOnAFaceByHalfAndOnAnEdgeByAQuarter) {
  const double area = std::numbers::pi * 0.2 * 0.2;
  EXPECT_NEAR(porosity(std::vector{Segment{{-1, 0.5, 0}, {2, 0.5, 0}}}, 0.4, kUnitBox), 1 - area / 2, 2e-5);
  EXPECT_NEAR(porosity(std::vector{Segment{{1, 1, -1}, {1, 1, 2}}}, 0.4, kUnitBox), 1 - area / 4, 2e-4);
}

TEST(Porosity, CountsCoincidentFibresOnceAndCapsToo) {
  const Segment capsule{{0.3, 0.5, 0.5}, {0.7, 0.5, 0.5}};
  const double r = 0.2, volume = std::numbers::pi * r * r * (0.4 + 4.0 / 3 * r);
  EXPECT_NEAR(porosity(std::vector{capsule, capsule, capsule}, 2 * r, kUnitBox), 1 - volume, 2e-5);
}

TEST(Porosity, DoesNotDependOnTheBoxesLongestEdge) {
  const std::vector<Segment> axes{{{0.1, 0.2, 0.3}, {0.9, 0.7, 0.4}}, {{0.5, 0.1, 0.9}, {0.2, 0.8, 0.1}}};
  const Bounds along_x{{-1, 0, 0}, {2, 1, 1}}, along_y{{0, -1, 0}, {1, 2, 1}}, along_z{{0, 0, -1}, {1, 1, 2}};
  const double reference = voxel_porosity(axes, 0.1, {{-1, -1, -1}, {2, 2, 2}}, 150);  // no box clips these fibres
  for (const Bounds& box : {along_x, along_y, along_z})
    EXPECT_NEAR(9 * (1 - reference), 1 - porosity(axes, 0.1, box), 1e-3);
}

TEST(FibreDiameter, ForAPorosityGivesThatPorosity) {
  for (const double target : {0.30, 0.75, 0.80, 0.88, 0.999}) {
    const double diameter = fibre_diameter_for_porosity(paper_lattice(), target);
    RecordProperty(fmt::format("diameter_at_porosity_{:.3f}", target), fmt::format("{:.8f}", diameter));
    EXPECT_GT(porosity(paper_lattice(), diameter * (1 - 1e-6)), target);
    EXPECT_LT(porosity(paper_lattice(), diameter * (1 + 1e-6)), target);
  }
}

TEST(FibreDiameter, OfARandomNetworkIsFoundAgainFromItsPorosity) {
  RandomGeometry random(23);
  std::vector<Segment> axes;
  for (int k = 0; k < 8; ++k) axes.push_back({random.in_cube(1.2), random.in_cube(1.2)});
  const Bounds box{{-1, -1, -1}, {1, 1, 1}};
  for (const double diameter : {0.01, 0.1, 0.5}) {
    const double found = fibre_diameter_for_porosity(axes, box, porosity(axes, diameter, box));
    EXPECT_NEAR(found, diameter, 1e-6 * diameter);
  }
}

TEST(FibreDiameter, RefusesAPorosityOutOfReachWithItsValueAndTheRange) {
  const auto message_for = [](double target) {
    try {
      fibre_diameter_for_porosity(std::vector{Segment{{0, 0, 0}, {0, 0, 0}}}, kUnitBox, target);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string("nothing thrown");
  };
  // One sphere on a corner, at most of the box's edge in diameter, takes pi/48 = 0.0654 of the box.
  EXPECT_NE(message_for(0.5).find("porosity = 0.5"), std::string::npos) << message_for(0.5);
  EXPECT_NE(message_for(0.5).find("[0.934"), std::string::npos) << message_for(0.5);
  EXPECT_NE(message_for(1).find("porosity = 1"), std::string::npos) << message_for(1);
  EXPECT_NE(message_for(NAN).find("porosity = nan"), std::string::npos) << message_for(NAN);
  EXPECT_EQ(message_for(0.95), "nothing thrown");
}

TEST(Porosity, RefusesABoxWithoutVolumeAndANegativeDiameter) {
  EXPECT_THROW(porosity(std::vector<Segment>{}, 0.1, {{0, 0, 0}, {1, 1, 0}}), std::invalid_argument);
  EXPECT_THROW(porosity(std::vector<Segment>{}, -0.1, kUnitBox), std::invalid_argument);
  EXPECT_EQ(porosity(std::vector<Segment>{}, 0.1, kUnitBox), 1);
  EXPECT_THROW(fibre_diameter_for_porosity(std::vector<Segment>{}, kUnitBox, 0.5), std::invalid_argument);
}

}  // namespace
}  // namespace scree
