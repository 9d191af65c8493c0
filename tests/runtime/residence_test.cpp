// Residence times of grains whose way is known, and what is left at which junction.
#include "runtime/residence.h"

#include <gtest/gtest.h>
#include <spdlog/spdlog.h>

#include <cmath>
#include <random>

#include "geometry/octet_lattice.h"
#include "runtime/junctions.h"
#include "runtime/render/colour_map.h"
#include "runtime/residence_pictures.h"
#include "tests/runtime/case_text.h"
#include "tests/scenes.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

constexpr double kGravity = 9.81;

// A layer from z = 0.2 to z = 0.1 m; nothing touches anything.
Case falling_case() {
  Case c = empty_case(2e-5);
  add_material(c, {"grain", 2500, 1e6, 0.3});
  c.pairs = {{0, 0, 0.5, 0.5, 0}};
  add_kind(c, 0, 0.001), add_kind(c, 0, 0.002);
  c.gravity = {0, 0, -kGravity};
  c.output.residence = {.enabled = true, .interval = 1e-3, .entry = 0.2, .exit = 0.1};
  return c;
}

struct Fall {
  explicit Fall(const Case& c) : c(c), engine(make_engine(c)), residence(c, engine->dt()) {}
  void until(double time) {
    while (engine->time() < time) {
      engine->step();
      const uint64_t step = engine->counters().steps;
      if (residence.schedule().after(step - 1) == step) residence.look(view());
    }
  }
  RunView view() { return {c, *engine, c.solid, stage, 0, path, log}; }
  std::string text_of(const char* file) {
    std::ifstream stream(path / file);
    return {std::istreambuf_iterator<char>(stream), {}};
  }

  testing::Folder folder;
  fs::path path = folder.path("");
  Case c;
  std::unique_ptr<Engine> engine;
  Residence residence;
  std::string stage = "fall";
  spdlog::logger log{"test"};
};

double fall_time(double height) { return std::sqrt(2 * height / kGravity); }

// From rest at h the layer takes sqrt(2 (h - 0.1) / g) - sqrt(2 (h - 0.2) / g).
TEST(Residence, OfFreelyFallingGrainsIsTheClosedForm) {
  Fall run(falling_case());
  std::vector<ParticleState> grains;
  std::vector<double> expected;
  for (int k = 0; k < 20; ++k) {
    const double height = 0.21 + 0.013 * k;
    grains.push_back(sphere(run.c, 0, {0.01 * k, 0, height}));
    expected.push_back(fall_time(height - 0.1) - fall_time(height - 0.2));
  }
  run.engine->insert(grains);
  run.until(0.4);
  const ResidenceTimes times = run.residence.times();
  ASSERT_EQ(times.taken.size(), grains.size());
  std::ranges::sort(expected);
  const double curvature = kGravity * 1e-6 / 8 / 1.0;  // s: the straight line between looks against the parabola
  for (size_t k = 0; k < expected.size(); ++k) {
    EXPECT_NEAR(times.taken[k].first, expected[k], 1e-3);
    EXPECT_NEAR(times.taken[k].first, expected[k], 1e-4 + 20 * curvature) << "crossings are placed between looks";
    EXPECT_NEAR(times.taken[k].second, grains[0].mass, 1e-7 * grains[0].mass);
  }
}

TEST(Residence, FiguresAreByMass) {
  const ResidenceTimes times{{{1, 6}, {2, 1}, {3, 2}, {10, 1}}};
  EXPECT_DOUBLE_EQ(times.mass(), 10);
  EXPECT_DOUBLE_EQ(times.mean(), 2.4);
  EXPECT_DOUBLE_EQ(times.quantile(0.5), 1);
  EXPECT_DOUBLE_EQ(times.quantile(0.65), 2);
  EXPECT_DOUBLE_EQ(times.quantile(0.9), 3);
  EXPECT_DOUBLE_EQ(times.quantile(1), 10);
}

TEST(Residence, BinsHoldAllMassAndAreAsWideAsAsked) {
  const ResidenceTimes times{{{0.001, 1}, {0.0199, 2}, {0.02, 4}, {0.0305, 8}}};
  const std::vector<ResidenceBin> asked = bins_of(times, 0.01, 1e-3);
  ASSERT_EQ(asked.size(), 4u);
  const double masses[] = {1, 2, 4, 8};
  for (size_t k = 0; k < 4; ++k) EXPECT_EQ(asked[k].mass, masses[k]) << k;
  EXPECT_DOUBLE_EQ(asked[3].from, 0.03);
  const std::vector<ResidenceBin> chosen = bins_of(times, 0, 1e-3);
  EXPECT_DOUBLE_EQ(chosen[0].to, 1e-3);  // not finer than the looks
  double sum = 0;
  for (const ResidenceBin& bin : chosen) sum += bin.mass;
  EXPECT_EQ(sum, 15);
  EXPECT_TRUE(bins_of({}, 0, 1e-3).empty());
}

// One waits in the layer from the start, one enters before the drain begins: neither has gone through.
TEST(Residence, CountsOnlyWhatEntersWhileTheDrainIsOpen) {
  Case c = falling_case();
  c.stages = {{"hold", SettleStage{}}, {"empty", DrainStage{}}};
  Fall run(c);
  const std::vector<ParticleState> grains = {sphere(c, 0, {0, 0, 0.15}), sphere(c, 0, {0.01, 0, 0.201}),
                                             sphere(c, 1, {0.02, 0, 0.3})};
  run.engine->insert(grains);
  run.stage = "hold";
  run.until(0.05);
  run.stage = "empty";
  run.until(0.4);
  run.residence.finish(run.view());
  const nlohmann::json s = run.residence.summary();
  EXPECT_EQ(s["grains_through"], 1);
  EXPECT_NEAR(s["went_through_kg"].get<double>(), grains[2].mass, 1e-6 * grains[2].mass);
  EXPECT_NEAR(s["median_s"].get<double>(), fall_time(0.2) - fall_time(0.1), 1e-3);
}

// Removed in the layer between two looks: gone by then, within the resolution.
TEST(Residence, OfAGrainThatIsTakenOutEndsThere) {
  Case c = falling_case();
  c.output.residence.interval = 5e-3;
  Fall run(c);
  run.engine->set_removal([](const ParticleState& p) { return p.position.z < 0.12 ? 0 : -1; });
  const ParticleState grain = sphere(c, 0, {0, 0, 0.25});
  run.engine->insert({&grain, 1});
  run.until(0.4);
  EXPECT_EQ(run.engine->count(), 0u);
  const ResidenceTimes times = run.residence.times();
  ASSERT_EQ(times.taken.size(), 1u);
  const double left = fall_time(0.13) - fall_time(0.05);
  EXPECT_GT(times.taken[0].first, left - 5e-3);
  EXPECT_LT(times.taken[0].first, left + 0.04);  // taken out at a rebuild of the lists, some way beyond
}

TEST(Residence, GoesOnFromACheckpointAsIfNothingHadHappened) {
  const Case c = falling_case();
  std::vector<ParticleState> grains;
  for (int k = 0; k < 5; ++k) grains.push_back(sphere(c, 0, {0.01 * k, 0, 0.22 + 0.02 * k}));
  Fall whole(c), first(c), second(c);
  whole.engine->insert(grains), first.engine->insert(grains);
  whole.until(0.4);
  first.until(0.1203);
  const fs::path path = first.folder.path("state.h5");
  {
    Hdf5Writer file(path);
    StateWriter out(file);
    first.engine->save(out), first.residence.save(out, "observers/residence");
    file.close();
  }
  Hdf5Reader file(path);
  StateReader in(file);
  second.engine->load(in), second.residence.load(in, "observers/residence");
  second.until(0.4);
  EXPECT_EQ(second.residence.times().taken, whole.residence.times().taken);
  EXPECT_EQ(second.residence.times().taken.size(), 5u);
}

TEST(Residence, WritesWhatIsLeftAtEachJunction) {
  Case c = falling_case();
  c.gravity = {0, 0, 0};
  const OctetLattice lattice = octet_lattice(0.04, {1, 1, 2}, {0, 0, 0.1});
  add_solid(c, fibre_primitives(lattice, 0.002, {0, 0}));
  c.output.residence.entry = 0.18;
  Fall run(c);
  const Vec3 junction{0.02, 0.02, 0.14};  // centre of the face between the two cells
  const std::vector<ParticleState> grains = {sphere(c, 0, junction + Vec3{0, 0, 0.004}),
                                             sphere(c, 1, junction + Vec3{0.004, -0.004, 0.0045}),
                                             sphere(c, 0, {0.02, 0.02, 0.5}),  // above the layer
                                             sphere(c, 0, {0.3, 0.3, 0.15})};  // beside the lattice
  run.engine->insert(grains);
  run.until(0.002);
  run.residence.finish(run.view());
  const std::string text = run.text_of("retained.csv");
  EXPECT_TRUE(text.starts_with("x_m,y_m,z_m,mass_kg,grains,")) << text;
  EXPECT_EQ(std::ranges::count(text, '\n'), 1 + static_cast<long>(lattice.nodes.size()));
  EXPECT_NE(text.find(fmt::format("0.02,0.02,0.14,{:.6g}", grains[0].mass + grains[1].mass).substr(0, 20)),
            std::string::npos)
      << text;
  const nlohmann::json s = run.residence.summary();
  EXPECT_EQ(s["retained_grains"], 3);
  EXPECT_NEAR(s["retained_at_no_junction_kg"].get<double>(), grains[3].mass, 1e-6 * grains[3].mass);
}

// One lies on a node, one on the middle of a fibre between two: both have a nearest node, one is at it.
TEST(Residence, TellsWhatIsLeftAtANodeFromWhatIsLeftAlongFibres) {
  Case c = falling_case();
  c.gravity = {0, 0, 0};
  const double fibre = 0.002, grain = 0.001;  // m, diameter; radius
  const OctetLattice lattice = octet_lattice(0.04, {1, 1, 2}, {0, 0, 0.1});
  add_solid(c, fibre_primitives(lattice, fibre, {0, 0}));
  c.output.residence.entry = 0.18;
  Fall run(c);
  const Vec3 node{0.02, 0.02, 0.14}, other{0.04, 0.04, 0.14}, up{0, 0, 0.5 * fibre + grain};
  const Vec3 along = unit(other - node), edge = 0.25 * norm(other - node) * along;  // as far as "near" goes
  const double mass = sphere(c, 0, node).mass;
  const std::vector<ParticleState> grains = {sphere(c, 0, node + up), sphere(c, 0, 0.5 * (node + other) + up),
                                             sphere(c, 0, node + 0.99 * edge + Vec3{0, 0, 1e-4}),
                                             sphere(c, 0, node - 1.01 * edge)};
  run.engine->insert(grains);
  run.residence.finish(run.view());
  const nlohmann::json s = run.residence.summary();
  EXPECT_EQ(s["retained_near_junctions_grains"], 2);
  EXPECT_EQ(s["retained_along_fibres_grains"], 2);
  EXPECT_NEAR(s["retained_near_junctions_kg"].get<double>(), 2 * mass, 1e-6 * mass);
  EXPECT_NEAR(s["retained_along_fibres_kg"].get<double>(), 2 * mass, 1e-6 * mass);
  std::istringstream rows(run.text_of("retained.csv"));
  std::string line;
  std::getline(rows, line);
  EXPECT_EQ(line, "x_m,y_m,z_m,mass_kg,grains,near_kg,near_grains,along_fibres_kg,along_fibres_grains");
  double near = 0, rest = 0, all = 0;
  while (std::getline(rows, line)) {
    double row[9];
    std::istringstream cells(line);
    for (double& x : row) {
      std::string cell;
      std::getline(cells, cell, ',');
      x = std::stod(cell);
    }
    all += row[4], near += row[6], rest += row[8];
    EXPECT_EQ(row[4], row[6] + row[8]);
    EXPECT_NEAR(row[3], row[5] + row[7], 1e-6 * mass);
  }
  EXPECT_EQ(all, 4);
  EXPECT_EQ(near, 2);
  EXPECT_EQ(rest, 2);
}

// ---- pictures

size_t pixels_of(const Image& image, const Srgb& colour, int from, int to) {
  size_t count = 0;
  for (int y = 0; y < image.height(); ++y)
    for (int x = from; x < to; ++x) count += image.at(x, y) == colour;
  return count;
}

TEST(ResidencePictures, BarsAreAsTallAsTheMassAndColouredByTheShareThatIsThrough) {
  const testing::Folder folder;
  write_residence_pictures(folder.path("residence"), falling_case(), {{0, 0.1, 1e-6}, {0.1, 0.2, 0}, {0.2, 0.3, 3e-6}},
                           {}, 5e-6);
  const Image image = read_png(fs::path(folder.path("residence")) / "times.png");
  const int bar = image.width() - 100;  // where the colour bar begins, at the earliest
  const size_t first = pixels_of(image, colour_of(ColourMap::sequential, 0.25), 0, bar);
  const size_t last = pixels_of(image, colour_of(ColourMap::sequential, 1), 0, bar);
  EXPECT_NEAR(static_cast<double>(last) / static_cast<double>(first), 3, 0.05);
  EXPECT_NEAR(static_cast<double>(last), 760 / 3.0 * 420 / 1.05, 1500);
  EXPECT_FALSE(fs::exists(fs::path(folder.path("residence")) / "retained.png"));  // there are no junctions
}

TEST(ResidencePictures, JunctionsAreWhereTheyAreAndColouredByWhatIsLeft) {
  const testing::Folder folder;
  Case c = falling_case();
  const OctetLattice lattice = octet_lattice(0.04, {1, 1, 2}, {0, 0, 0.1});
  add_solid(c, fibre_primitives(lattice, 0.002, {0, 0}));
  c.fibres.diameter = 0.004;
  std::vector<Retained> retained;
  for (const Vec3& node : lattice.nodes) retained.push_back({.at = node});
  const auto drawn = [&](const Vec3& heavy, const Vec3& light) {
    for (Retained& r : retained) {
      r.mass = norm(r.at - heavy) < 1e-6 ? 4e-6 : norm(r.at - light) < 1e-6 ? 2e-6 : 0;
      r.grains = r.mass > 0;
    }
    write_residence_pictures(folder.path("residence"), c, {}, retained, 0);
    return read_png(fs::path(folder.path("residence")) / "retained.png");
  };
  const Srgb most = colour_of(ColourMap::sequential, 1), half = colour_of(ColourMap::sequential, 0.5);
  const auto rows_of = [&](const Image& image, const Srgb& colour, int from, int to) {
    double sum = 0, count = 0;
    for (int y = 0; y < image.height(); ++y)
      for (int x = from; x < to; ++x)
        if (image.at(x, y) == colour) sum += y, ++count;
    EXPECT_GT(count, 50);
    return sum / count;
  };
  const Image image = drawn({0.04, 0.02, 0.16}, {0.02, 0.02, 0.14});  // in the right-hand face; in the middle
  const int middle = image.width() / 2 - 20, bar = image.width() - 110;
  // From the front it is at the right edge, from the side in the middle; once in each map; the higher above the lower.
  EXPECT_LT(rows_of(image, most, 0, middle), rows_of(image, half, 0, middle) - 50);
  EXPECT_LT(rows_of(image, most, middle, bar), rows_of(image, half, middle, bar) - 50);
  EXPECT_NEAR(rows_of(image, most, 0, middle), rows_of(image, most, middle, bar), 1);
  // Two that lie behind each other from the front are one there: of 6 mg only in that map.
  const Image behind = drawn({0.02, 0.04, 0.12}, {0.02, 0, 0.12});
  EXPECT_GT(pixels_of(behind, most, 0, middle), 50u);
  EXPECT_EQ(pixels_of(behind, most, middle, bar), 0u);
  EXPECT_FALSE(fs::exists(fs::path(folder.path("residence")) / "times.png"));
}

TEST(ResidencePictures, ARunLeavesBoth) {
  Case c = falling_case();
  add_solid(c, fibre_primitives(octet_lattice(0.04, {1, 1, 2}, {0.2, 0.2, 0.1}), 0.002, {0, 0}));
  Fall run(c);
  const ParticleState grain = sphere(c, 0, {0, 0, 0.25});
  run.engine->insert({&grain, 1});
  run.until(0.2);
  run.residence.finish(run.view());
  EXPECT_GT(read_png(run.path / "residence" / "times.png").width(), 700);
  EXPECT_GT(read_png(run.path / "residence" / "retained.png").width(), 300);
}

TEST(Junctions, OfAnOctetLatticeAreItsNodesAndReachEverywhere) {
  const OctetLattice lattice = octet_lattice(0.01, {3, 2, 2}, {-0.005, 0.001, 0.2});
  Solid solid{{"lattice"}, fibre_primitives(lattice, 0.001, {0, 0})};
  const Junctions junctions(solid);
  EXPECT_EQ(junctions.points().size(), lattice.nodes.size());
  EXPECT_NEAR(junctions.reach(), 0.005, 1e-12);
  std::mt19937 random(3);
  const Bounds box = section_of(lattice);
  const auto within = [&](double a, double b) { return std::uniform_real_distribution(a, b)(random); };
  for (int k = 0; k < 2000; ++k) {
    const Vec3 x{within(box.min.x, box.max.x), within(box.min.y, box.max.y), within(box.min.z, box.max.z)};
    const auto nearest = junctions.nearest(x);
    ASSERT_TRUE(nearest);
    double least = 1;
    for (const Vec3& node : lattice.nodes) least = std::min(least, norm(node - x));
    ASSERT_NEAR(norm(junctions.points()[*nearest] - x), least, 1e-12);
  }
  EXPECT_FALSE(junctions.nearest(box.max + Vec3{0.006, 0, 0}));
  EXPECT_FALSE(Junctions(Solid{}).nearest({0, 0, 0}));
}

}  // namespace
}  // namespace scree
