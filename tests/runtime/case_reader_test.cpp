// What a good case file becomes: values, defaults, bases, overrides, and the way there and back.
#include "runtime/case_reader.h"

#include <gtest/gtest.h>

#include <set>

#include "runtime/case_size.h"
#include "runtime/case_writer.h"
#include "tests/runtime/case_text.h"

namespace scree {
namespace {

using testing::describe;
using testing::Folder;
using testing::kGoodCase;

std::string error_of(const std::string& path, const std::vector<std::string>& overrides = {}) {
  try {
    read_case(path, overrides);
  } catch (const CaseError& error) {
    return error.what();
  }
  return "";
}

TEST(CaseReader, ReadsValuesAndFillsDefaults) {
  Folder folder;
  const Case c = read_case(folder.write("good.toml", kGoodCase));
  EXPECT_EQ(c.title, "good");
  EXPECT_EQ(c.seed, 7u);
  EXPECT_EQ(c.contact.rolling, RollingModel::epsd2);
  EXPECT_EQ(c.contact.precision, Precision::mixed);
  EXPECT_EQ(c.time.step, 5e-6);
  ASSERT_EQ(c.materials.size(), 2u);
  EXPECT_EQ(c.materials[1].density, 0);
  EXPECT_EQ(c.pairs[1].sliding_friction, 0.5);
  EXPECT_EQ(c.kinds[0].size.diameters, std::vector<double>{400e-6});
  EXPECT_EQ(c.solid.walls, (std::vector<std::string>{"lattice", "hopper", "lid"}));
  EXPECT_EQ(c.solid.primitives.size(), 68u + 4 + 1);
  EXPECT_EQ(c.fibres.count, 68u);
  EXPECT_NEAR(c.fibres.porosity, 0.886, 1e-3);
  EXPECT_EQ(c.outlets[0].remove_beyond, 2e-3);
  ASSERT_EQ(c.stages.size(), 4u);
  EXPECT_EQ(c.stages[3].name, "drain");
  const auto& fill = std::get<FillStage>(c.stages[0].action);
  EXPECT_EQ(fill.mixture.mass_fractions, std::vector<double>{1.0});
  EXPECT_EQ(fill.solid_fraction, 0.55);
  EXPECT_EQ(std::get<SettleStage>(c.stages[1].action).max_time, 0.1);
}

TEST(CaseReader, FitsTheDomainToWhatIsInIt) {
  Folder folder;
  const Case c = read_case(folder.write("good.toml", kGoodCase));
  EXPECT_LT(c.domain.min.x, -10e-3);
  EXPECT_GT(c.domain.max.z, 44e-3);
  EXPECT_LT(c.domain.min.z, -2e-3);  // beyond where the outlet removes
}

TEST(CaseReader, SolvesTheFibreDiameterForAPorosity) {
  Folder folder;
  const Case c = read_case(folder.write("good.toml", kGoodCase), {"lattice.porosity=0.80"});
  EXPECT_NEAR(c.fibres.porosity, 0.80, 1e-6);
  EXPECT_NEAR(c.fibres.diameter, 1.36e-3, 0.02e-3);
  EXPECT_EQ(c.solid.primitives[0].radius, c.fibres.diameter / 2);
}

TEST(CaseReader, WritingAndReadingGivesTheSameCase) {
  Folder folder;
  const Case once =
      read_case(folder.write("good.toml", kGoodCase), {"lattice.porosity=0.8", "output.steady_window=[0.1, 0.2]"});
  const Case again = read_case(folder.write("again.toml", write_case(once)));
  EXPECT_EQ(describe(once), describe(again));
  EXPECT_NE(once.understood.find("limit_attraction = false  # default"), std::string::npos);
  EXPECT_NE(once.understood.find("porosity = 0.8  # fibre_diameter 0.00136804 m was solved for"), std::string::npos)
      << once.understood;
}

TEST(CaseReader, BasesMergeAndTheLaterWins) {
  Folder folder;
  folder.write("common.toml", kGoodCase);
  folder.write("parts/friction.toml",
               "base = '../common.toml'\n[[pair]]\nmaterials = ['steel', 'bead']\nsliding_friction = 0.3\n");
  const Case c = read_case(folder.write("child.toml", R"(base = ["common.toml", "parts/friction.toml"]
title = "child"
time.rayleigh_fraction = 0.1
lattice.porosity = 0.75
[[wall]]
name = "hopper"
z = [20e-3, 30e-3]
[[wall]]
name = "lid"
kind = "disc"
material = "steel"
centre = [0, 0, 20e-3]
radius = 8e-3
[[region]]
name = "inside"
max = [4e-3, 4e-3, 30e-3]
[[stage]]
kind = "fill"
regions = "inside"
count = 100
)"));
  EXPECT_EQ(c.title, "child");
  EXPECT_EQ(c.seed, 7u);
  EXPECT_EQ(c.time.step, 0);  // the choice replaces the base's
  EXPECT_EQ(c.time.rayleigh_fraction, 0.1);
  EXPECT_EQ(c.pairs[1].sliding_friction, 0.3);
  EXPECT_EQ(c.pairs[1].restitution, 0.41);
  EXPECT_EQ(c.solid.walls.size(), 3u);
  EXPECT_TRUE(
      std::holds_alternative<Revolution>(c.solid.primitives.back().skeleton));  // another kind replaces the wall
  EXPECT_EQ(c.regions[0].max.z, 30e-3);
  EXPECT_EQ(c.regions[0].min.z, 21e-3);
  ASSERT_EQ(c.stages.size(), 1u);  // stages are replaced as a whole
  EXPECT_EQ(std::get<FillStage>(c.stages[0].action).count, 100u);
}

TEST(CaseReader, ErrorsNameTheFileWhereTheKeyStands) {
  Folder folder;
  const std::string common = folder.write("common.toml", std::string(kGoodCase) + "\n[neighbour]\nskin = -1\n");
  const std::string child = folder.write("child.toml", "base = 'common.toml'\n");
  const std::string message = error_of(child);
  EXPECT_EQ(message.find(common + ":"), 0u) << message;
  EXPECT_NE(message.find("neighbour.skin"), std::string::npos) << message;
}

TEST(CaseReader, BasesThatLeadBackAreRefused) {
  Folder folder;
  folder.write("a.toml", "base = 'b.toml'\n");
  folder.write("b.toml", "\nbase = 'a.toml'\n");
  const std::string message = error_of(folder.path("a.toml"));
  EXPECT_NE(message.find("b.toml:2:8: key 'base': 'a.toml' leads back to itself"), std::string::npos) << message;
  EXPECT_NE(error_of(folder.write("c.toml", "base = 'none.toml'")).find("none.toml' cannot be read"),
            std::string::npos);
  EXPECT_NE(error_of(folder.write("d.toml", "base = [3]")).find("d.toml:1:9: key 'base': 3"), std::string::npos);
  EXPECT_NE(error_of(folder.path("absent.toml")).find("absent.toml: the file"), std::string::npos);
}

TEST(CaseReader, OverridesReachEveryTable) {
  Folder folder;
  const Case c =
      read_case(folder.write("good.toml", kGoodCase),
                {"contact.rolling=cdt", "title=\"over\"", "lattice.fibre_diameter=1.36e-3",
                 "material.steel.youngs_modulus=2e7", "pair.steel+bead.restitution=0.6", "stage.fill.count=123",
                 "neighbour.skin=1e-4", "watch.max_overlap=0.1", "gravity=[0, 0, -1.62]"});
  EXPECT_EQ(c.contact.rolling, RollingModel::cdt);
  EXPECT_EQ(c.title, "over");
  EXPECT_EQ(c.fibres.diameter, 1.36e-3);
  EXPECT_EQ(c.materials[1].youngs_modulus, 2e7);
  EXPECT_EQ(c.pairs[1].restitution, 0.6);
  EXPECT_EQ(std::get<FillStage>(c.stages[0].action).count, 123u);
  EXPECT_EQ(c.neighbour.skin, 1e-4);
  EXPECT_EQ(c.watch.max_overlap, 0.1);
  EXPECT_EQ(c.gravity.z, -1.62);
}

TEST(CaseReader, WrongOverridesSayWhichOne) {
  Folder folder;
  const std::string path = folder.write("good.toml", kGoodCase);
  const std::pair<const char*, const char*> wrong[] = {
      {"contact.rolling", "--set contact.rolling: an override is written key.path=value"},
      {"=3", "--set =3: an override is written key.path=value"},
      {"contact.roling=cdt", "--set contact.roling=cdt: key 'contact.roling': unknown key (value \"cdt\")"},
      {"contact.rolling=cdtt", "unknown value 'cdtt', known: none, cdt, epsd2; did you mean 'cdt'?"},
      {"time.step=", "--set time.step=: '' is not a TOML value"},
      {"time.step=5e", "--set time.step=5e: '5e' is not a TOML value"},
      {"time.step=-1", "--set time.step=-1: key 'time.step': -1 is out of range"},
      {"time.step=1\nseed=2", "one value is needed"},
      {"material.stel.density=1000",
       "key 'material.stel': there is no such material, known: bead, steel; did you mean 'steel'?"},
      {"material.steel=3", "names a whole material"},
      {"title.x=3", "is not inside a table"},
      {"time..step=3", "an empty part"},
  };
  for (const auto& [text, expected] : wrong) {
    const std::string message = error_of(path, {text});
    EXPECT_NE(message.find(expected), std::string::npos) << text << " gave: " << message;
  }
}

TEST(CaseSize, MeanVolumesOfDistributions) {
  SizeDistribution list;
  list.diameters = {1e-3, 2e-3};
  list.fractions = {0.5, 0.5};
  // By mass, half the mass in each: 8 small for 1 large. By number: the plain mean.
  const double small = mean_particle_volume({SizeDistribution::Kind::list, {1e-3}, {1.0}});
  EXPECT_NEAR(mean_particle_volume(list), small * 16 / 9, 1e-6 * small);
  list.fractions_by_mass = false;
  EXPECT_NEAR(mean_particle_volume(list), small * 4.5, 1e-6 * small);
  SizeDistribution normal{SizeDistribution::Kind::normal, {}, {}, true, 1e-3, 1e-4, 0.5e-3, 1.5e-3};
  EXPECT_NEAR(mean_particle_volume(normal) / small, 1 + 3 * 0.01, 1e-4);  // E[d^3] = m^3 + 3 m s^2
  SizeDistribution lognormal{SizeDistribution::Kind::lognormal, {}, {}, true, 1e-3, 0.1, 0.5e-3, 2e-3};
  EXPECT_NEAR(mean_particle_volume(lognormal) / small, std::exp(4.5 * 0.01), 1e-3);  // exp(9 s^2 / 2)
}

TEST(CaseSize, VolumesOfRegions) {
  Region r;
  r.shape = Region::Shape::frustum;
  r.bottom_x = 0.05, r.bottom_y = 0.01, r.top_x = 0.08, r.top_y = 0.04, r.height = 0.12;
  EXPECT_NEAR(volume_of(r), 204e-6, 1e-12);  // the paper's hopper
}

// Every case that is shipped; those that are only parts of others are read through them. Sweeps are no cases.
TEST(ShippedCases, ReadAndComeBackTheSame) {
  namespace fs = std::filesystem;
  const std::set<std::string> parts = {"olhx/common.toml", "olhx/full_width.toml", "examples/common_box.toml"};
  const fs::path root = fs::path(SCREE_SOURCE_DIR) / "cases";
  Folder folder;
  int count = 0;
  for (const auto& entry : fs::recursive_directory_iterator(root)) {
    if (entry.path().extension() != ".toml" || parts.contains(fs::relative(entry.path(), root).string())) continue;
    if (entry.path().filename().string().starts_with("sweep_")) continue;
    SCOPED_TRACE(entry.path().string());
    ++count;
    Case c;
    ASSERT_NO_THROW(c = read_case(entry.path().string())) << error_of(entry.path().string());
    const Case again = read_case(folder.write("again.toml", write_case(c)));
    EXPECT_EQ(describe(c), describe(again));
    EXPECT_GT(expected_particles(c), 0);
  }
  EXPECT_GE(count, 19);
}

TEST(ShippedCases, ThePapersMassIsThePapersNumberOfGrains) {
  const Case c = read_case(std::string(SCREE_SOURCE_DIR) + "/cases/olhx/paper_088.toml");
  EXPECT_NEAR(expected_particles(c), 971'721, 1);
  EXPECT_EQ(c.fibres.count, 1460u);
}

}  // namespace
}  // namespace scree
