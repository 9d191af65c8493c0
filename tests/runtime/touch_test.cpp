// Touch maps: the surface is cut into cells, some of which are none, and touches are counted where they are.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "geometry/closest_point.h"
#include "runtime/render/colour_map.h"
#include "runtime/touch_files.h"
#include "runtime/touch_maps.h"
#include "runtime/touch_numbers.h"
#include "tests/oracle/beds.h"
#include "tests/runtime/case_text.h"
#include "tests/vtk_reader.h"

namespace scree {
namespace {

constexpr double kFibre = 3e-4;  // m, radius

Case with_fibres(const std::vector<Segment>& axes) {
  Case c = ceramic_case({{-0.01, -0.01, -0.01}, {0.01, 0.01, 0.01}});
  c.gravity = {0, 0, -9.81};
  c.solid.walls = {"fibres", "wall"};
  for (const Segment& s : axes) c.solid.primitives.push_back({s, kFibre, 1, 0});
  c.fibres.count = axes.size();
  c.fibres.section = {{-2e-3, -2e-3, -2e-3}, {2e-3, 2e-3, 2e-3}};
  c.output.touch.enabled = true, c.output.touch.cell = 4e-4, c.output.touch.during = During::always;
  return c;
}

double share_of(const TouchSurface& s, TouchState state) {
  return static_cast<double>(std::ranges::count(s.states(), state)) / static_cast<double>(s.size());
}

TEST(TouchSurface, APointOnACellIsInThatCell) {
  Case c =
      with_fibres({{{0, 0, 0}, {2e-3, 1e-3, 1e-3}}, {{0, 1e-3, 0}, {0, 4e-3, 0}}, {{3e-3, 0, 2e-3}, {3e-3, 0, 0}}});
  c.solid.primitives.push_back(rectangle({-5e-3, -5e-3, -5e-3}, {4e-3, 0, 0}, {0, 3e-3, 4e-3}, {1, 1}).front());
  c.output.touch.walls = {1};
  const TouchSurface surface(c);
  ASSERT_EQ(surface.patches().size(), 4u);
  for (const TouchPatch& p : surface.patches())
    for (uint32_t row = 0; row < p.rows; ++row)
      for (uint32_t column = 0; column < p.columns; ++column) {
        const Vec3 x = p.at(p.length * (row + 0.5) / p.rows, (column + 0.5) / p.columns);
        EXPECT_NEAR(distance(c.solid.primitives[p.primitive], x), 0, 1e-12);
        EXPECT_EQ(surface.cell_of(p.primitive, x), p.first + size_t(row) * p.columns + column);
      }
}

TEST(TouchSurface, AnglesCountFromTheTop) {
  const TouchSurface surface(with_fibres({{{-2e-3, 0, 0}, {2e-3, 0, 0}}, {{0, 1e-3, -1e-3}, {0, 3e-3, 1e-3}}}));
  for (const TouchPatch& p : surface.patches()) {
    EXPECT_GT(p.outward(0).z, 0.7);
    EXPECT_LT(p.outward(0.5).z, -0.7);
    for (uint32_t column = 0; column < p.columns; ++column)
      EXPECT_EQ(looks_up(p, column), p.outward((column + 0.5) / p.columns).z > 0);
  }
}

TEST(TouchSurface, WhatLiesInAnotherFibreIsNone) {
  const TouchSurface alone(with_fibres({{{-2e-3, 0, 0}, {2e-3, 0, 0}}}));
  EXPECT_EQ(share_of(alone, TouchState::open), 1.0);
  const Case c = with_fibres({{{-2e-3, 0, 0}, {2e-3, 0, 0}}, {{0, -2e-3, 0}, {0, 2e-3, 0}}});
  const TouchSurface crossed(c);
  size_t hidden = 0;
  for (const TouchPatch& p : crossed.patches())
    for (uint32_t row = 0; row < p.rows; ++row)
      for (uint32_t column = 0; column < p.columns; ++column) {
        const Vec3 x = p.at(p.length * (row + 0.5) / p.rows, (column + 0.5) / p.columns);
        const bool inside = distance(c.solid.primitives[1 - p.primitive], x) < 0;
        const bool is_hidden = crossed.states()[p.first + size_t(row) * p.columns + column] == TouchState::hidden;
        EXPECT_EQ(is_hidden, inside);
        hidden += is_hidden;
      }
  EXPECT_GT(hidden, 0u);
}

TEST(TouchSurface, TheHalfBeyondAWallIsNone) {
  Case c = with_fibres({{{-1.9e-3, 2e-3, 0}, {1.9e-3, 2e-3, 0}}});
  c.solid.primitives.push_back(rectangle({-2e-3, 2e-3, -2e-3}, {4e-3, 0, 0}, {0, 0, 4e-3}, {1, 1}).front());
  EXPECT_NEAR(share_of(TouchSurface(c), TouchState::hidden), 0.5, 1e-9);
  c.stages = {{"open", OpenStage{{"wall"}}}};  // one that a stage takes away hides nothing
  EXPECT_EQ(share_of(TouchSurface(c), TouchState::hidden), 0.0);
}

TEST(TouchSurface, WhereNoGrainFitsIsOutOfReach) {
  const double gap = 2 * kFibre + kRadius;  // half a grain between two fibres
  const TouchSurface surface(with_fibres({{{-2e-3, 0, 0}, {2e-3, 0, 0}}, {{-2e-3, gap, 0}, {2e-3, gap, 0}}}));
  for (const TouchPatch& p : surface.patches())
    for (uint32_t column = 0; column < p.columns; ++column) {
      const Vec3 out = p.outward((column + 0.5) / p.columns);
      const double inwards = p.primitive == 0 ? out.y : -out.y;
      const TouchState state = surface.states()[p.first + column];
      if (inwards > 0.9) {
        EXPECT_EQ(state, TouchState::out_of_reach);
      }
      if (inwards < 0) {
        EXPECT_EQ(state, TouchState::open);
      }
    }
}

TEST(TouchSurface, OnlyCellsInsideAFaceAreItsSurface) {
  Case c = with_fibres({});
  c.solid.primitives = frustum({0, 0, 0, 2e-3, 2e-3, 6e-3, 8e-3, 8e-3}, {1, 1});
  c.output.touch.walls = {1}, c.output.touch.cell = 1e-4;
  const TouchSurface surface(c);
  ASSERT_EQ(surface.patches().size(), 4u);
  for (const TouchPatch& p : surface.patches()) {
    double area = 0;
    for (size_t cell = p.first; cell < p.first + p.cells(); ++cell)
      if (surface.states()[cell] != TouchState::hidden) area += p.cell_area();
    EXPECT_NEAR(area / (0.5 * (2e-3 + 8e-3) * std::hypot(6e-3, 3e-3)), 1, 0.02);
  }
}

// ---- counting

ContactState contact_at(const Case& c, size_t primitive, const Vec3& near, double force, double rub) {
  ContactState k;
  k.j = primitive, k.with_solid = true, k.overlap = 1e-7;
  const Vec3 axis = closest_on_skeleton(c.solid.primitives[primitive], near);
  k.normal = unit(near - axis), k.point = axis + kFibre * k.normal;
  const Vec3 sideways = perpendicular_to(k.normal);
  k.force = force * k.normal - rub * sideways, k.slip = 0.5 * sideways;
  return k;
}

TEST(TouchMaps, CountLooksGrainsForceAndRubbingInTheirCells) {
  const Case c = with_fibres({{{-2e-3, 0, 0}, {2e-3, 0, 0}}, {{-2e-3, 2e-3, 0}, {2e-3, 2e-3, 0}}});
  const TouchSurface surface(c);
  TouchRecord record;
  record.cells.resize(surface.size());
  const ContactState one = contact_at(c, 0, {1e-4, 1e-4, 1e-3}, 2, 1),
                     other = contact_at(c, 0, {1e-4, 1e-4, 1e-3}, 4, 0);
  add_touches(surface, std::vector{one, other}, record);
  add_touches(surface, std::vector{one}, record);
  add_touches(surface, std::vector<ContactState>{}, record);
  add_touches(surface, std::vector{contact_at(c, 0, {4e-3, 0, 1e-4}, 1, 0)}, record);  // a round end
  EXPECT_EQ(record.looks, 4u);
  EXPECT_EQ(record.elsewhere, 1u);
  const TouchSums& cell = record.cells.at(surface.cell_of(0, one.point));
  EXPECT_EQ(cell.touched, 2u);
  EXPECT_EQ(cell.contacts, 3u);
  EXPECT_DOUBLE_EQ(cell.force, 8);
  EXPECT_DOUBLE_EQ(cell.rubbing, 1.0);  // 1 N times 0.5 m/s, twice
  const auto all = [](uint32_t, uint32_t) { return true; };
  const TouchMeans touched = means_of(surface.patches()[0], surface, record, all);
  const TouchMeans untouched = means_of(surface.patches()[1], surface, record, all);
  EXPECT_NEAR(touched.dead_share(), 1 - 1.0 / surface.patches()[0].cells(), 1e-12);
  EXPECT_NEAR(touched.touched_share(), 0.5 / surface.patches()[0].cells(), 1e-12);
  EXPECT_DOUBLE_EQ(touched.mean_force(), 8.0 / 3);
  EXPECT_NEAR(touched.area, 2 * std::numbers::pi * kFibre * 4e-3, 1e-12);
  EXPECT_NEAR(touched.rubbing_per_area(), 1.0 / (4 * touched.area), 1e-9 / touched.area);
  EXPECT_EQ(untouched.dead_share(), 1.0);
  EXPECT_EQ(untouched.touched_share(), 0.0);
}

// A sphere in the groove of two level fibres, without friction: N = m g / (2 cos a) on either, a from the vertical.
TEST(TouchMaps, OfASphereAtRestAreItsTwoCellsAllTheTimeWithItsWeight) {
  const double half = 4e-4;  // m, between the axes, halved
  Case c = with_fibres({{{-2e-3, -half, 0}, {2e-3, -half, 0}},
                        {{-2e-3, half, 0}, {2e-3, half, 0}},
                        {{-2e-3, 4e-3, 0}, {2e-3, 4e-3, 0}}});
  c.pairs[1].sliding_friction = c.pairs[1].rolling_friction = 0;
  const double reach = kRadius + kFibre, height = std::sqrt(reach * reach - half * half);
  const auto engine = make_engine(c);
  engine->insert(std::vector{grain({1e-4, 0, height})});
  run_steps(*engine, 20000);
  TouchMaps maps(c, engine->dt());
  const testing::Folder folder;
  const std::string stage = "rest";
  const std::filesystem::path out = folder.path("");
  spdlog::logger log{"test"};
  const RunView view{c, *engine, c.solid, stage, 0, out, log};
  for (int look = 0; look < 20; ++look, run_steps(*engine, 10)) maps.look(view);
  EXPECT_EQ(maps.record().looks, 20u);
  const double mass = sphere_mass(kRadius, kDensity), expected = mass * 9.81 / (2 * height / reach);
  size_t touched = 0;
  for (size_t cell = 0; cell < maps.surface().size(); ++cell) {
    const TouchSums& sums = maps.record().cells[cell];
    if (sums.contacts == 0) continue;
    ++touched;
    EXPECT_EQ(sums.touched, 20u);
    EXPECT_EQ(sums.contacts, 20u);
    EXPECT_NEAR(sums.force / 20 / expected, 1, 1e-3);
  }
  EXPECT_EQ(touched, 2u);
  const nlohmann::json j = touch_summary(c, maps.surface(), maps.record());
  EXPECT_NEAR(j["fibres"]["dead_share"].get<double>(), 1 - 2.0 / maps.surface().size(), 1e-12);
  EXPECT_EQ(j["fibres"]["lower_half"]["dead_share"], 1.0);
}

// A sphere that slides along the groove until it rolls: friction J turns it, v = v0 - J / m, w = J r / (2/5 m R^2) with
// r = R cos(a) to the contacts, until v = w r: J = m s / (1 + 5/2 cos^2 a) with s the slip v0 - w0 r at the beginning.
// The slip falls evenly from s to 0, so the work is J s / 2. Rolling, with its contacts sticking, it does none. The
// first step is not in it: at no spring yet the dashpot acts alone and without a limit, as in LIGGGHTS.
TEST(TouchMaps, HaveTheWorkOfAGrainThatSlidesUntilItRolls) {
  const double half = 4e-4, reach = kRadius + kFibre, height = std::sqrt(reach * reach - half * half), speed = 0.04;
  Case c = with_fibres({{{-2e-3, -half, 0}, {2e-3, -half, 0}}, {{-2e-3, half, 0}, {2e-3, half, 0}}});
  c.pairs[1].sliding_friction = 0.5, c.pairs[1].rolling_friction = 0;
  const auto resting = make_engine(c), engine = make_engine(c);
  resting->insert(std::vector{grain({-1e-3, 0, height})});
  run_steps(*resting, 20000);
  ParticleState start = resting->particle(0);
  start.velocity = {speed, 0, 0};
  engine->insert(std::vector{start});
  engine->step();
  const double cosine = height / reach, mass = sphere_mass(kRadius, kDensity);
  const ParticleState sliding_from = engine->particle(0);
  const double slip = sliding_from.velocity.x - sliding_from.spin.y * kRadius * cosine;
  const TouchSurface surface(c);
  TouchRecord record;
  record.cells.resize(surface.size());
  const auto work_after = [&](int steps) {
    for (int k = 0; k < steps; ++k, engine->step()) add_touches(surface, engine->contacts(), record);
    double sum = 0;
    for (const TouchSums& cell : record.cells) sum += cell.rubbing * engine->dt();
    return sum;
  };
  const double expected = 0.5 * mass * slip * slip / (1 + 2.5 * cosine * cosine);
  const double sliding = work_after(2000);
  EXPECT_NEAR(sliding / expected, 1, 0.01);
  EXPECT_NEAR(engine->particle(0).velocity.x / speed, 1 - 1 / (1 + 2.5 * cosine * cosine), 0.02);
  EXPECT_NEAR(work_after(2000) / sliding, 1, 0.01);
}

// The force per contact at one end is three times that at the other, which has four times the contacts.
TEST(TouchMaps, HaveAPictureOfEachQuantity) {
  const testing::Folder folder;
  Case c = with_fibres({{{-2e-3, 0, 0}, {2e-3, 0, 0}}});
  const TouchSurface surface(c);
  TouchRecord record;
  record.cells.resize(surface.size());
  for (const double side : {-1e-3, 1e-5, 1e-3}) {  // three cells round the fibre at either end
    const ContactState hard = contact_at(c, 0, {-1.5e-3, side, 1e-3}, 3, 1),
                       soft = contact_at(c, 0, {1.5e-3, side, 1e-3}, 1, 1);
    add_touches(surface, std::vector{hard, soft, soft, soft, soft}, record);
  }
  const std::filesystem::path out = folder.path("touch");
  std::filesystem::create_directories(out);
  write_touch_pictures(out, c, surface, record);
  // Rows (from below) of the cells with the largest value; the touched cells are off the colour bar's side.
  const auto height_of = [&](const char* file) {
    const Image image = read_png(out / (std::string("fibres_") + file + ".png"));
    const Srgb most = colour_of(ColourMap::sequential, 1);
    double sum = 0, count = 0;
    for (int y = 0; y < image.height(); ++y)
      for (int x = 0; x < 360; ++x)
        if (image.at(x, y) == most) sum += image.height() - y, ++count;
    EXPECT_GT(count, 100) << file;
    return sum / count;
  };
  const double low = height_of("mean_normal_force"), high = height_of("contacts");
  EXPECT_GT(std::abs(high - low), 150);         // which end is below is open: the fibre is level
  EXPECT_NEAR(height_of("pressure"), high, 1);  // 4 N against 3 N
  EXPECT_NEAR(height_of("sliding_work"), high, 1);
  EXPECT_GT(read_png(out / "fibres_touched_share.png").width(), 300);
  EXPECT_FALSE(std::filesystem::exists(out / "fibres_normal_force.png"));
}

TEST(TouchMaps, AreReadByVtkAsTheyAre) {
  if (!has_vtk_reader()) GTEST_SKIP() << kNoVtkReader;
  const testing::Folder folder;
  const Case c = with_fibres({{{-2e-3, 0, 0}, {2e-3, 0, 0}}, {{0, -2e-3, 0}, {0, 2e-3, 0}}});
  const TouchSurface surface(c);
  TouchRecord record;
  record.cells.resize(surface.size());
  const ContactState k = contact_at(c, 0, {1.5e-3, 1e-4, 1e-3}, 2, 0);
  add_touches(surface, std::vector{k}, record);
  add_touches(surface, std::vector<ContactState>{}, record);
  write_touch_vtkhdf(folder.path("t.vtkhdf"), c, surface, record);
  const VtkData d = read_with_vtk({folder.path("t.vtkhdf")}).at(0);
  EXPECT_EQ(d.class_name, "vtkUnstructuredGrid");
  const auto exposed = static_cast<size_t>(surface.size() - std::ranges::count(surface.states(), TouchState::hidden));
  ASSERT_EQ(d.cells.size(), exposed);
  const VtkArray share = d.array("cell_data", "touched_share"), force = d.array("cell_data", "mean_normal_force");
  size_t touched = 0;
  for (size_t cell = 0; cell < exposed; ++cell) {
    ASSERT_EQ(d.cells[cell].size(), 5u);  // a quadrilateral
    if (share.values[cell] == 0) continue;
    ++touched;
    EXPECT_FLOAT_EQ(share.values[cell], 0.5);
    EXPECT_FLOAT_EQ(force.values[cell], 2);
    Vec3 middle{0, 0, 0};
    for (size_t n = 1; n < 5; ++n) {
      const double* x = &d.points.values[3 * static_cast<size_t>(d.cells[cell][n])];
      middle += 0.25 * Vec3{x[0], x[1], x[2]};
    }
    EXPECT_LT(norm(middle - k.point), 3e-4);
  }
  EXPECT_EQ(touched, 1u);
}

}  // namespace
}  // namespace scree
