// Averaged fields keep the laws that the particles keep.
#include "runtime/averages.h"

#include <gtest/gtest.h>

#include <functional>

#include "geometry/bounds.h"
#include "geometry/closest_point.h"
#include "kernels/parallel.h"
#include "runtime/average_files.h"
#include "runtime/average_junctions.h"
#include "runtime/average_lanes.h"
#include "tests/oracle/beds.h"
#include "tests/runtime/case_text.h"
#include "tests/vtk_reader.h"

namespace scree {
namespace {

AverageSettings average_over(const Bounds& box, double spacing, double width) {
  AverageSettings a;
  a.name = "all", a.box = box, a.spacing = spacing, a.width = width, a.during = During::always;
  return a;
}

constexpr Bounds kBox{{0, 0, 0}, {0.004, 0.005, 0.006}};

// A look at particles that are placed and have not moved.
AverageSums looked_at(const Case& c, const AverageSettings& a, const std::vector<ParticleState>& grains) {
  const auto engine = make_engine(c);
  engine->insert(grains);
  AverageSums sums(grid_of(a, c));
  sums.add(*engine, c);
  return sums;
}

std::vector<ParticleState> cloud(size_t count, const std::function<Vec3(const Vec3&)>& velocity) {
  Random random(11);
  std::vector<ParticleState> grains;
  for (size_t k = 0; k < count; ++k) {
    const Vec3 x = random.in({kBox.min - Vec3{1e-3, 1e-3, 1e-3}, kBox.max + Vec3{1e-3, 1e-3, 1e-3}});
    grains.push_back(grain(x, random.between(1e-4, 2e-4), velocity(x)));
  }
  return grains;
}

Case open_case() { return ceramic_case({{-0.01, -0.01, -0.01}, {0.02, 0.02, 0.02}}); }

TEST(Averages, HoldTheMassMomentumAndVolumeOfTheGrainsInside) {
  const Case c = open_case();
  const AverageSettings a = average_over(kBox, 4e-4, 8e-4);
  Random random(2);
  const auto grains = cloud(800, [&](const Vec3&) { return random.in({{-1, -1, -1}, {1, 1, 1}}); });
  const AverageSums sums = looked_at(c, a, grains);
  const AverageFields f = sums.fields(c);
  double mass = 0, volume = 0, flux = 0, expected_mass = 0, expected_volume = 0, expected_momentum = 0;
  for (size_t k = 0; k < sums.grid().size(); ++k)
    mass += f.bulk_density[k], volume += f.solid_fraction[k], flux += f.mass_flux[k].z;
  for (const ParticleState& p : grains)
    if (contains(kBox, p.position)) {
      expected_mass += sphere_mass(p.radius, kDensity), expected_volume += sphere_mass(p.radius, 1);
      expected_momentum += sphere_mass(p.radius, kDensity) * p.velocity.z;
    }
  const double cell = sums.grid().cell_volume();
  EXPECT_NEAR(mass * cell / expected_mass, 1, 1e-6);  // masses are stored in single precision
  EXPECT_NEAR(volume * cell / expected_volume, 1, 1e-12);
  EXPECT_NEAR(flux * cell / expected_momentum, 1, 1e-5);
}

// Grains fly in and out between three looks: the field's integral is the mean of what was in.
TEST(Averages, OverAWindowHoldTheMeanMassThatWasInside) {
  const Case c = open_case();
  const auto engine = make_engine(c);
  std::vector<ParticleState> grains;  // apart from each other, and flying side by side
  for (double z = -1e-3; z < 7e-3; z += 6e-4)
    for (double y = -1e-3; y < 6e-3; y += 6e-4)
      for (double x = -1.7e-3; x < 5e-3; x += 6e-4) grains.push_back(grain({x, y, z}, 2e-4, {2, 0.5, -1}));
  engine->insert(grains);
  AverageSums sums(grid_of(average_over(kBox, 4e-4, 8e-4), c));
  std::vector<double> inside;
  for (int look = 0; look < 3; ++look) {
    sums.add(*engine, c);
    inside.push_back(engine->sum([](const ParticleState& p) { return contains(kBox, p.position) ? p.mass : 0; }));
    for (int k = 0; k < 40; ++k) engine->step();
  }
  EXPECT_GT(std::abs(inside[2] / inside[0] - 1), 0.01) << "nothing went in or out";
  const double mean = (inside[0] + inside[1] + inside[2]) / 3;
  double mass = 0;
  for (const double density : sums.fields(c).bulk_density) mass += density * sums.grid().cell_volume();
  EXPECT_NEAR(mass / mean, 1, 1e-6);
}

TEST(Averages, OfAUniformFlowAreItsVelocityAndNoTemperature) {
  const Case c = open_case();
  const Vec3 v{0.25, -0.5, 1};  // as they are in single precision
  const AverageSums sums = looked_at(c, average_over(kBox, 4e-4, 8e-4), cloud(800, [&](const Vec3&) { return v; }));
  const AverageFields f = sums.fields(c);
  size_t seen = 0;
  for (size_t k = 0; k < sums.grid().size(); ++k) {
    if (std::isnan(f.velocity[k].x)) continue;
    ++seen;
    ASSERT_NEAR(norm(f.velocity[k] - v), 0, 1e-12);
    ASSERT_NEAR(f.temperature[k], 0, 1e-12);
    ASSERT_NEAR(norm(f.mass_flux[k] - f.bulk_density[k] * f.velocity[k]), 0, 1e-9);
    for (const double s : f.stress[k]) ASSERT_NEAR(s, 0, 1e-9 * f.bulk_density[k]);
  }
  EXPECT_GT(seen, sums.grid().size() / 2);
}

// Two grains in each place with opposite velocities: no mean velocity, all is fluctuation.
TEST(Averages, OfOppositeVelocitiesAreATemperatureAndAPressure) {
  const Case c = open_case();
  std::vector<ParticleState> grains;
  for (const ParticleState& p : cloud(400, [](const Vec3&) { return Vec3{0, 0, 0.5}; })) {
    grains.push_back(p), grains.push_back(p);
    grains.back().velocity = {0, 0, -0.5};
  }
  const AverageSums sums = looked_at(c, average_over(kBox, 4e-4, 8e-4), grains);
  const AverageFields f = sums.fields(c);
  for (size_t k = 0; k < sums.grid().size(); ++k) {
    if (std::isnan(f.velocity[k].x)) continue;
    ASSERT_NEAR(norm(f.velocity[k]), 0, 1e-12);
    ASSERT_NEAR(f.temperature[k], 0.25 / 3, 1e-9);
    ASSERT_NEAR(f.stress[k][2], f.bulk_density[k] * 0.25, 1e-6 * f.bulk_density[k]);
    ASSERT_NEAR(f.stress[k][0], 0, 1e-9 * f.bulk_density[k]);
  }
}

// A steady shear has no temperature though grains of one cell differ in velocity.
TEST(Averages, TakeAGradientOfTheFlowOutOfTheTemperature) {
  const Case c = open_case();
  const double shear = 200;  // 1/s
  std::vector<ParticleState> grains;
  for (double z = -1e-3; z < 7e-3; z += 1e-4)
    for (double y = -1e-3; y < 6e-3; y += 2e-4)
      for (double x = -1e-3; x < 5e-3; x += 2e-4) grains.push_back(grain({x, y, z}, 5e-5, {shear * z, 0, 0}));
  const AverageSums sums = looked_at(c, average_over(kBox, 4e-4, 8e-4), grains);
  const AverageFields f = sums.fields(c);
  const double uncorrected = shear * shear * kernel_variance(sums.grid()) / 3;
  const auto& n = sums.grid().cells;
  double mean = 0, cells = 0;
  for (int k = 4; k < n[2] - 4; ++k)  // away from the faces, which cut the kernel
    for (int j = 3; j < n[1] - 3; ++j)
      for (int i = 3; i < n[0] - 3; ++i, ++cells) mean += f.temperature[(size_t(k) * n[1] + j) * n[0] + i];
  EXPECT_LT(mean / cells, 0.1 * uncorrected);
}

// d sigma_zz / dz = -rho g: what lies above a layer rests on it, over the whole area.
TEST(Averages, StressOfABedAtRestIsTheWeightAbove) {
  const LooseBed bed{7, 7, 10};
  const Case c = bed_case(bed);
  const auto engine = make_engine(c);
  engine->insert(bed.particles({0, 0, 0}, 5));
  run_steps(*engine, 40000);  // 0.2 s
  const Bounds box{{c.domain.min.x, c.domain.min.y, 0}, c.domain.max};
  AverageSums sums(grid_of(average_over(box, 2e-4, 4e-4), c));
  for (int look = 0; look < 5; ++look, run_steps(*engine, 20)) sums.add(*engine, c);
  const AverageFields f = sums.fields(c);
  const CoarseGrid& g = sums.grid();
  ASSERT_TRUE(g.wrap[0] && g.wrap[1] && !g.wrap[2]);
  const size_t layer = size_t(g.cells[0]) * g.cells[1];
  const auto mean = [&](int k, const auto& value) {
    double sum = 0;
    for (size_t cell = k * layer; cell < (k + 1) * layer; ++cell) sum += value(cell);
    return sum / static_cast<double>(layer);
  };
  double above = 0;  // Pa
  for (int k = g.cells[2] - 1; k >= 0; --k) {
    const double own = 9.81 * g.spacing.z * mean(k, [&](size_t cell) { return f.bulk_density[cell]; });
    const double stress = mean(k, [&](size_t cell) { return f.stress[cell][2]; });
    if (k >= 3) {
      EXPECT_NEAR(stress, above + 0.5 * own, 0.04 * (above + own) + 0.3) << "layer " << k;
    }
    above += own;
  }
  EXPECT_GT(above, 20.0);  // Pa: there was something to carry
}

TEST(Averages, AreTheSameForAnyNumberOfThreads) {
  const Case c = open_case();
  const auto grains = cloud(3000, [](const Vec3& x) { return 100.0 * x; });
  const int before = thread_count();
  const auto bits = [&](int threads) {
    set_thread_count(threads);
    const AverageFields f = looked_at(c, average_over(kBox, 3e-4, 8e-4), grains).fields(c);
    std::vector<double> all = f.solid_fraction;
    for (const Vec3& v : f.mass_flux) all.push_back(v.x + v.y + v.z);
    return all;
  };
  EXPECT_EQ(bits(1), bits(3));
  set_thread_count(before);
}

// Grains above a crossing of fibres, none below.
TEST(Averages, SeeWhatLiesAboveAndBelowJunctions) {
  Case c = open_case();
  c.gravity = {0, 0, -9.81};
  const Vec3 at{2e-3, 2e-3, 3e-3};
  c.solid.walls = {"fibres"};
  for (const Vec3& way : {Vec3{1, 1, 0}, Vec3{-1, 1, 0}, Vec3{1, -1, 0}, Vec3{-1, -1, 0}})
    c.solid.primitives.push_back({Segment{at, at + 1e-3 * way}, 3e-4, 1, 0});
  c.fibres.count = 4;
  std::vector<ParticleState> grains;
  for (const ParticleState& p : cloud(1500, [](const Vec3&) { return Vec3{0, 0, -0.25}; }))
    if (p.position.z > at.z) grains.push_back(p);
  const AverageSums sums = looked_at(c, average_over(kBox, 2e-4, 4e-4), grains);
  const nlohmann::json j = junction_summary(c, sums.grid(), sums.fields(c));
  EXPECT_EQ(j["count"], 5);  // and the four ends
  EXPECT_GT(j["above"]["solid_fraction"].get<double>(), 0.02);
  EXPECT_EQ(j["below"]["solid_fraction"].get<double>(), 0);
  EXPECT_NEAR(j["above"]["downward_velocity_m_per_s"].get<double>(), 0.25, 1e-6);
  EXPECT_TRUE(j["below"]["speed_m_per_s"].is_null());
}

// Everywhere the same mixture in what the fibres leave free, twice as fast above the crossing as below: the share of
// free space is that mixture's, also beside the fibres, and speeds are over the mean of the section.
TEST(Averages, DivideWhatLiesAtJunctionsByTheFreeSpaceAndTheSpeedOfTheSection) {
  Case c = open_case();
  c.gravity = {0, 0, -9.81};
  const Vec3 at{2e-3, 2.5e-3, 3e-3};
  c.solid.walls = {"fibres"};
  for (const Vec3& way : {Vec3{1, 1, 0}, Vec3{-1, 1, 0}, Vec3{1, -1, 0}, Vec3{-1, -1, 0}})
    c.solid.primitives.push_back({Segment{at, at + 1e-3 * way}, 3e-4, 1, 0});
  c.fibres.count = 4, c.fibres.section = {{0, 0, 1e-3}, {4e-3, 5e-3, 5e-3}};
  // Points rather than grains, on a fine grid outside the fibres.
  const double fine = 1e-4, radius = 1e-5, fraction = sphere_mass(radius, 1) / std::pow(fine, 3);
  const auto inside = [&](const Vec3& x) {
    return std::ranges::any_of(c.solid.primitives, [&](const Primitive& p) { return distance(p, x) < 0; });
  };
  std::vector<ParticleState> grains;
  for (double z = 0.5 * fine; z < 6e-3; z += fine)
    for (double y = 0.5 * fine; y < 5e-3; y += fine)
      for (double x = 0.5 * fine; x < 4e-3; x += fine)
        if (!inside({x, y, z})) grains.push_back(grain({x, y, z}, radius, {0, 0, z > at.z ? -0.5 : -0.25}));
  const AverageSettings a = average_over(kBox, 2e-4, 8e-4);  // a wide kernel sees much of the fibres
  const auto sums = looked_at(c, a, grains);
  const nlohmann::json j = junction_summary(c, sums.grid(), sums.fields(c));
  for (const char* side : {"above", "below"}) {
    const nlohmann::json& probe = j[side];
    EXPECT_NEAR(probe["solid_fraction_of_free_space"].get<double>() / fraction, 1, 0.03) << side;
    EXPECT_LT(probe["solid_fraction"].get<double>(), 0.97 * fraction) << side;
    EXPECT_GT(probe["solid_fraction"].get<double>(), 0.5 * fraction) << side;
  }
  const double mean = j["section_mean_speed_m_per_s"].get<double>();
  EXPECT_NEAR(mean, 0.375, 0.005);
  EXPECT_NEAR(j["above"]["speed_over_section_mean"].get<double>(), 0.5 / mean, 0.1);
  EXPECT_NEAR(j["below"]["speed_over_section_mean"].get<double>(), 0.25 / mean, 0.1);
}

// A made-up field: flux 1 downwards everywhere, 3 in a lane that swings to and fro in x, a fibre in a corner.
TEST(Lanes, AreWhereTheFluxIsLargestAndAsMuchAboveTheMean) {
  CoarseGrid g;
  g.origin = {-1e-3, -2e-3, 0}, g.spacing = {1e-4, 1e-4, 1e-4}, g.cells = {20, 40, 30}, g.width = 2e-4;
  AverageFields f;
  f.mass_flux.assign(g.size(), {0, 0, -1}), f.free_share.assign(g.size(), 1);
  const auto cell = [&](int i, int j, int k) { return (size_t(k) * g.cells[1] + j) * g.cells[0] + i; };
  const auto swing = [](int k) { return 10 + static_cast<int>(std::lround(5 * std::sin(0.4 * k))); };
  for (int k = 0; k < 28; ++k) {
    f.mass_flux[cell(swing(k), 25, k)] = {0, 0, -3};
    for (int i = 0; i < 10; ++i)
      for (int j = 0; j < 10; ++j) f.mass_flux[cell(i, j, k)] = {0, 0, 0}, f.free_share[cell(i, j, k)] = 0;
  }
  for (size_t at = cell(0, 0, 28); at < cell(0, 0, 29); ++at) f.mass_flux[at] = {0, 0, 0.5};  // upwards: no lane
  for (size_t at = cell(0, 0, 29); at < g.size(); ++at) f.mass_flux[at] = {0, 0, 0};
  const std::vector<Lane> lanes = lanes_of(g, f, 0, 1);
  ASSERT_EQ(lanes.size(), 28u);
  for (int k = 0; k < 28; ++k) {
    EXPECT_NEAR(lanes[k].z, (k + 0.5) * 1e-4, 1e-12);
    EXPECT_NEAR(lanes[k].peak_over_mean, 3 * 700.0 / 702, 1e-9);  // of the free cells
    EXPECT_NEAR(lanes[k].x, -1e-3 + (swing(k) + 0.5) * 1e-4, 1e-12);
    EXPECT_NEAR(lanes[k].y, 0.55e-3, 1e-12);
    EXPECT_NEAR(lanes[k].from_axis, std::hypot(lanes[k].x, 0.55e-3), 1e-12);
  }
  Case c = open_case();
  const nlohmann::json all = lane_summary(c, g, f);
  EXPECT_EQ(all["layers"]["z_m"].size(), 28u);
  EXPECT_NEAR(all["distance_from_axis_m"]["most"].get<double>(), 0.78e-3, 0.02e-3);
  EXPECT_NEAR(all["peak_over_mean"]["mean"].get<double>(), 3, 0.01);
  c.fibres.count = 1, c.fibres.section = {{-1e-3, -2e-3, 1e-3}, {1e-3, 2e-3, 2e-3}};
  EXPECT_EQ(lane_summary(c, g, f)["layers"]["z_m"].size(), 10u);  // within the lattice
  f.mass_flux.assign(g.size(), {0, 0, 0});
  EXPECT_TRUE(lane_summary(c, g, f).is_null());
}

TEST(Averages, AreReadByVtkAsTheyAre) {
  if (!has_vtk_reader()) GTEST_SKIP() << kNoVtkReader;
  const testing::Folder folder;
  const Case c = open_case();
  const AverageSums sums =
      looked_at(c, average_over(kBox, 1e-3, 1.5e-3), cloud(300, [](const Vec3& x) { return 100.0 * x; }));
  const AverageFields f = sums.fields(c);
  write_average_vtkhdf(folder.path("a.vtkhdf"), sums.grid(), f);
  const VtkData d = read_with_vtk({folder.path("a.vtkhdf")}).at(0);
  EXPECT_EQ(d.class_name, "vtkImageData");
  const VtkArray density = d.array("point_data", "bulk_density"), flux = d.array("point_data", "mass_flux"),
                 stress = d.array("point_data", "stress");
  ASSERT_EQ(density.values.size(), sums.grid().size());
  ASSERT_EQ(flux.components, 3u);
  ASSERT_EQ(stress.components, 6u);
  for (size_t k = 0; k < sums.grid().size(); ++k) {
    EXPECT_FLOAT_EQ(density.values[k], f.bulk_density[k]);
    EXPECT_FLOAT_EQ(flux.values[3 * k + 2], f.mass_flux[k].z);
    EXPECT_FLOAT_EQ(stress.values[6 * k + 2], f.stress[k][2]);
  }
}

}  // namespace
}  // namespace scree
