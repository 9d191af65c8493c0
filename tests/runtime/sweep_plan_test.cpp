// Sweep files: how their tables expand into runs, and what is refused, with the place and what is allowed.
#include <gtest/gtest.h>

#include "runtime/case_physics.h"
#include "runtime/case_reader.h"
#include "runtime/sweep_plan.h"
#include "tests/runtime/case_text.h"

namespace scree {
namespace {

SweepPlan plan_of(const testing::Folder& folder, const std::string& text) {
  folder.write("good.toml", testing::kGoodCase);
  return read_sweep(folder.write("sweep.toml", text));
}

std::vector<std::string> names_of(const SweepPlan& plan) {
  std::vector<std::string> names;
  for (const SweepRun& run : plan.runs) names.push_back(run.name);
  return names;
}

using Names = std::vector<std::string>;

TEST(SweepPlan, is_the_product_of_its_parameters_and_seeds) {
  const testing::Folder folder;
  const SweepPlan plan = plan_of(folder, R"(case = "good.toml"
seeds = [3, 5]
[[parameter]]
key = "contact.rolling"
values = ["cdt", "epsd2"]
[[parameter]]
key = "particles.grain.diameter"
label = "grain"
values = [400e-6, 500e-6]
)");
  EXPECT_EQ(names_of(plan), (Names{"rolling_cdt__grain_0.0004__seed_3", "rolling_cdt__grain_0.0004__seed_5",
                                   "rolling_cdt__grain_0.0005__seed_3", "rolling_cdt__grain_0.0005__seed_5",
                                   "rolling_epsd2__grain_0.0004__seed_3", "rolling_epsd2__grain_0.0004__seed_5",
                                   "rolling_epsd2__grain_0.0005__seed_3", "rolling_epsd2__grain_0.0005__seed_5"}));
  EXPECT_EQ(plan.runs[3].values, (std::vector<size_t>{0, 1}));
  EXPECT_EQ(plan.runs[3].seed, 5u);
  EXPECT_EQ(plan.parameters[1].values[1].number, 500e-6);
  EXPECT_EQ(plan.parameters[0].values[0].number, std::nullopt);
}

TEST(SweepPlan, each_run_is_the_case_with_its_keys_set) {
  const testing::Folder folder;
  const SweepPlan plan = plan_of(folder, R"(case = "good.toml"
set = {output.interval = 2e-3}
[[parameter]]
key = "pair.bead+bead.restitution"
values = [0.1, 0.9]
)");
  ASSERT_EQ(plan.runs.size(), 2u);
  const Case by_hand = read_case(folder.path("good.toml"), {"output.interval=2e-3", "pair.bead+bead.restitution=0.9"});
  EXPECT_EQ(plan.runs[1].understood, by_hand.understood);
  EXPECT_NE(plan.runs[0].understood, by_hand.understood);
}

TEST(SweepPlan, keys_in_rows_change_together) {
  const testing::Folder folder;
  const SweepPlan plan = plan_of(folder, R"(case = "good.toml"
[[parameter]]
label = "friction"
keys = ["pair.bead+bead.sliding_friction", "pair.bead+bead.rolling_friction"]
rows = [[0.1, 0.2], [0.3, 0.4]]
names = ["smooth", "rough"]
)");
  EXPECT_EQ(names_of(plan), (Names{"friction_smooth", "friction_rough"}));
  EXPECT_EQ(plan.runs[1].set, (Names{"pair.bead+bead.sliding_friction=0.3", "pair.bead+bead.rolling_friction=0.4"}));
}

TEST(SweepPlan, without_names_a_row_is_called_by_its_values) {
  const testing::Folder folder;
  const SweepPlan plan = plan_of(folder, R"(case = "good.toml"
[[parameter]]
keys = ["pair.bead+bead.sliding_friction", "contact.rolling"]
rows = [[0.1, "cdt"], [0.3, "epsd2"]]
)");
  EXPECT_EQ(names_of(plan), (Names{"sliding_friction_0.1_cdt", "sliding_friction_0.3_epsd2"}));
}

TEST(SweepPlan, a_swept_key_replaces_the_other_key_of_its_choice) {
  const testing::Folder folder;
  const SweepPlan plan = plan_of(folder, R"(case = "good.toml"
[[parameter]]
key = "lattice.porosity"
values = [0.8, 0.9]
)");
  EXPECT_EQ(names_of(plan), (Names{"porosity_0.8", "porosity_0.9"}));
}

TEST(SweepPlan, has_what_its_charts_are_held_against) {
  const testing::Folder folder;
  const SweepPlan plan = plan_of(folder, R"(case = "good.toml"
[reference]
label = "measured"
value = 7.8e-3
unit = "kg/s"
[captions]
steady_flow = "as measured at one porosity"
)");
  ASSERT_TRUE(plan.reference);
  EXPECT_EQ(plan.reference->label, "measured");
  EXPECT_EQ(plan.reference->value, 7.8e-3);
  EXPECT_EQ(plan.reference->unit, "kg/s");
  ASSERT_EQ(plan.captions.size(), 1u);
  EXPECT_EQ(plan.captions[0].chart, "steady_flow");
  EXPECT_EQ(plan.captions[0].text, "as measured at one porosity");
  EXPECT_FALSE(plan_of(folder, "case = \"good.toml\"\n").reference);
}

struct Wrong {
  const char* what;
  const char* text;      // behind 'case = "good.toml"'
  const char* expected;  // part of the message
};

// clang-format off
const Wrong kWrong[] = {
    {"unknown key", "seed = [1]", "sweep.toml:2:1: key 'seed': unknown key (value [1]), known here: title, case, seeds, set, reference, captions, parameter; did you mean 'seeds'?"},
    {"unknown key of a parameter", "[[parameter]]\nkey = \"seed\"\nvalue = [1]\n", "sweep.toml:4:1: key 'parameter[1].value': unknown key (value [1]), known here: key, keys, values; did you mean 'values'?"},
    {"a key that the case does not know", "[[parameter]]\nkey = \"lattice.porosty\"\nvalues = [0.8]\n", "sweep.toml:4:11: run 'porosty_0.8': --set lattice.porosty=0.8: key 'lattice.porosty': unknown key"},
    {"and what it may be", "[[parameter]]\nkey = \"lattice.porosty\"\nvalues = [0.8]\n", "did you mean 'porosity'?"},
    {"a value out of range", "[[parameter]]\nkey = \"pair.bead+bead.restitution\"\nvalues = [0.5, 1.5]\n", "sweep.toml:4:16: run 'restitution_1.5': --set pair.bead+bead.restitution=1.5: key 'pair.bead+bead.restitution': 1.5 is out of range, must be between 0 and 1"},
    {"a name that the case does not have", "[[parameter]]\nkey = \"material.gold.density\"\nvalues = [19300]\n", "there is no such material, known: bead, steel"},
    {"an unknown key in [set]", "[set]\noutput.intervall = 1\n", "key 'output.intervall': unknown key"},
    {"no value", "[[parameter]]\nkey = \"seed\"\nvalues = []\n", "sweep.toml:4:10: key 'parameter[1].values': [] is empty, must be a list of values"},
    {"no seed", "seeds = []", "sweep.toml:2:9: key 'seeds': [] is empty, must be a list of whole numbers"},
    {"no row", "[[parameter]]\nkeys = [\"seed\", \"title\"]\nrows = []\n", "key 'parameter[1].rows': [] is empty, must be a list of rows"},
    {"one value without a list", "[[parameter]]\nkey = \"seed\"\nvalues = 3\n", "key 'parameter[1].values': 3 is not a list, must be a list of values"},
    {"a short row", "[[parameter]]\nkeys = [\"seed\", \"title\"]\nrows = [[1, \"a\"], [2]]\n", "sweep.toml:4:19: key 'parameter[1].rows': the row [2] must be a list of 2 values, one for each of: seed, title"},
    {"seed of words", "seeds = [1, \"two\"]", "sweep.toml:2:13: key 'seeds': \"two\" must be a whole number, 0 or more"},
    {"too few names", "[[parameter]]\nkey = \"seed\"\nvalues = [1, 2]\nnames = [\"one\"]\n", "has 1 entries, must be 2: one for each value"},
    {"neither key nor keys", "[[parameter]]\nvalues = [1]\n", "key 'parameter[1].key': is missing, give one of: key, keys"},
    {"a value twice", "[[parameter]]\nkey = \"pair.bead+bead.restitution\"\nvalues = [0.5, 0.50]\n", "sweep.toml:4:16: two runs have the name 'restitution_0.5'"},
    {"values that differ in signs only", "[[parameter]]\nkey = \"title\"\nvalues = [\"a b\", \"a/b\"]\n", "two runs have the name 'title_a_b'"},
    {"a seed twice", "seeds = [1, 1]", "two runs have the name 'seed_1'"},
    {"a key twice", "[[parameter]]\nkey = \"seed\"\nvalues = [1]\n[[parameter]]\nkey = \"seed\"\nlabel = \"b\"\nvalues = [2]\n", "sweep.toml:6:7: the case's key 'seed' is set twice, the other time at"},
    {"seeds and the seed", "seeds = [1]\n[[parameter]]\nkey = \"seed\"\nvalues = [1]\n", "the case's key 'seed' is set twice"},
    {"set and swept", "[set]\noutput.interval = 1e-3\n[[parameter]]\nkey = \"output.interval\"\nvalues = [1e-3]\n", "the case's key 'output.interval' is set twice"},
    {"unknown key of the reference", "[reference]\nlabel = \"measured\"\nvalue = 7.8e-3\nunits = \"kg/s\"\n", "sweep.toml:5:1: key 'reference.units': unknown key (value \"kg/s\"), known here: label, value, unit; did you mean 'unit'?"},
    {"unknown key of a whole reference", "[reference]\nlabel = \"measured\"\nvalue = 7.8e-3\nunit = \"kg/s\"\ncolour = \"red\"\n", "sweep.toml:6:1: key 'reference.colour': unknown key (value \"red\"), known here: label, value, unit"},
    {"a reference in another unit", "[reference]\nlabel = \"measured\"\nvalue = 7.8\nunit = \"g/s\"\n", "sweep.toml:5:8: key 'reference.unit': unknown value 'g/s', known: kg/s, s, kg"},
    {"a reference of words", "[reference]\nlabel = \"measured\"\nvalue = \"7.8 g/s\"\nunit = \"kg/s\"\n", "sweep.toml:4:9: key 'reference.value': \"7.8 g/s\" is of the wrong type, must be a number"},
    {"a reference below nothing", "[reference]\nlabel = \"measured\"\nvalue = -1\nunit = \"s\"\n", "key 'reference.value': -1 is out of range, must be greater than 0"},
    {"a reference without a unit", "[reference]\nlabel = \"measured\"\nvalue = 1\n", "key 'reference.unit': is missing"},
    {"a reference without a name", "[reference]\nvalue = 1\nunit = \"s\"\n", "sweep.toml:2:1: key 'reference.label': is missing"},
    {"two references", "[[reference]]\nlabel = \"a\"\n[[reference]]\nlabel = \"b\"\n", "key 'reference': "},
    {"a caption of no chart", "[captions]\ndrain = \"as measured\"\n", "sweep.toml:3:1: key 'captions.drain': unknown key (value \"as measured\"), known here: flow_curves, discharged_curves, steady_flow, drain_time, retained"},
    {"two labels alike", "[[parameter]]\nkey = \"pair.bead+bead.restitution\"\nvalues = [0.1]\n[[parameter]]\nkey = \"pair.bead+steel.restitution\"\nvalues = [0.1]\n", "two parameters are called 'restitution': give this one another label"},
};
// clang-format on

TEST(SweepPlan, wrong_files_are_refused_with_the_place_and_what_is_allowed) {
  for (const Wrong& w : kWrong) {
    SCOPED_TRACE(w.what);
    const testing::Folder folder;
    try {
      plan_of(folder, std::string("case = \"good.toml\"\n") + w.text);
      ADD_FAILURE() << "it was accepted";
    } catch (const CaseError& e) {
      EXPECT_NE(std::string(e.what()).find(w.expected), std::string::npos) << e.what();
    }
  }
}

TEST(SweepPlan, every_shipped_sweep_is_in_order) {
  const std::filesystem::path cases = std::filesystem::path(SCREE_SOURCE_DIR) / "cases" / "olhx";
  const std::pair<const char*, size_t> shipped[] = {{"porosity", 6}, {"friction", 6}, {"rolling", 4}, {"diameter", 6}};
  for (const auto& [name, runs] : shipped)
    EXPECT_EQ(read_sweep((cases / fmt::format("sweep_{}.toml", name)).string()).runs.size(), runs) << name;
}

TEST(SweepPlan, the_shipped_diameters_keep_the_time_step_s_share_of_the_rayleigh_time) {
  const SweepPlan plan =
      read_sweep((std::filesystem::path(SCREE_SOURCE_DIR) / "cases/olhx/sweep_diameter.toml").string());
  const auto share = [](const Case& c) { return time_step_of(c) / smallest_rayleigh_time(c); };
  const double of_the_demo = share(read_case(plan.case_file, {}));
  for (const SweepRun& run : plan.runs)
    EXPECT_NEAR(share(read_case(plan.case_file, run.set)), of_the_demo, 1e-9) << run.name;
}

TEST(SweepPlan, the_case_must_be_there) {
  const testing::Folder folder;
  for (const auto& [text, expected] : {std::pair("title = \"x\"\n", "key 'case': is missing"),
                                       std::pair("case = \"other.toml\"\n", "other.toml\" does not exist")}) {
    try {
      plan_of(folder, text);
      ADD_FAILURE() << text;
    } catch (const CaseError& e) {
      EXPECT_NE(std::string(e.what()).find(expected), std::string::npos) << e.what();
    }
  }
}

TEST(SweepPlan, more_runs_than_can_be_meant_are_refused_before_they_are_listed) {
  const testing::Folder folder;
  std::string values = "[0";
  for (int k = 1; k < 200; ++k) values += fmt::format(", {}", k);
  try {
    plan_of(folder,
            fmt::format("case = \"good.toml\"\nseeds = {0}]\n[[parameter]]\nkey = \"title\"\nvalues = {0}]\n", values));
    ADD_FAILURE() << "it was accepted";
  } catch (const CaseError& e) {
    EXPECT_NE(std::string(e.what()).find("40000 runs, must be at most 10000"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace scree
