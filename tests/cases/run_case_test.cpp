// A run as a whole: what it writes, that it adds up, and how it ends when something is wrong.
#include <csignal>

#include "tests/cases/case_runs.h"

namespace scree {
namespace {

// A few hundred beads through an orifice: seconds.
const std::vector<std::string> kSmall{"stage.fill.mass=0.6e-3", "stage.settle.time=0.02", "stage.drain.max_time=0.05",
                                      "time.rayleigh_fraction=0.3"};
// The reader lets it pass, but walls and beads in so small a region do not pack to 0.6.
const std::vector<std::string> kTooDense{"stage.fill.mass=0.24e-3", "stage.fill.solid_fraction=0.6",
                                         "region.inside.radius=3e-3", "region.inside.height=6e-3"};
constexpr const char* kSilo = "examples/orifice_silo.toml";

TEST(RunCase, leaves_every_result_and_the_masses_add_up) {
  const TemporaryFolder folder;
  const auto out = folder.path() / "silo";
  const RunResult r = run_to(out, kSilo, kSmall);
  ASSERT_EQ(r.status, RunStatus::done) << r.message;
  for (const char* name : {"mass_flow.csv", "summary.json", "run.log", "case.toml", "particles.vtp"})
    EXPECT_TRUE(std::filesystem::exists(out / name)) << name;
  const nlohmann::json s = read_summary(out);
  for (const char* key : {"particles", "steps", "physical_time_s", "wall_time_s", "particle_steps_per_second",
                          "peak_rss_bytes", "steady_mass_flow_kg_per_s", "mass_discharged_kg", "mass_retained_kg",
                          "rebuilds", "lost_particles", "state_hash"})
    EXPECT_TRUE(s.contains(key)) << key;
  EXPECT_EQ(s["lost_particles"], 0);
  EXPECT_GT(s["mass_discharged_kg"].get<double>(), 0);
  EXPECT_NEAR(s["mass_discharged_kg"].get<double>() + s["mass_retained_kg"].get<double>(), 0.6e-3, 2e-6);
  const Table flow = read_table(out / "mass_flow.csv");
  EXPECT_EQ(flow.columns, (std::vector<std::string>{"time_s", "discharged_kg", "mass_flow_kg_per_s"}));
  EXPECT_NEAR(flow.rows.back()[1], s["mass_discharged_kg"].get<double>(), 1e-12);
  for (size_t k = 1; k < flow.rows.size(); ++k) EXPECT_GE(flow.rows[k][1], flow.rows[k - 1][1] - 1e-12);
}

TEST(RunCase, the_understood_case_runs_to_the_same_bits) {
  const TemporaryFolder folder;
  run_to(folder.path() / "first", kSilo, kSmall);
  RunOptions options;
  options.out = folder.path() / "second";
  options.engine.profile = true;  // which changes no bit, and prints:
  const RunResult second = run_case(read_case((folder.path() / "first" / "case.toml").string()), options);
  for (const char* stage :
       {"near checks", "particle-particle contacts", "fibre and wall contacts", "integration", "rebuild: histories",
        "rebuild: sort", "rebuild: pair search", "rebuild: fibre and wall search", "the rest", "all"})
    EXPECT_NE(second.profile.find(stage), std::string::npos) << stage << " in\n" << second.profile;
  EXPECT_EQ(read_summary(folder.path() / "first")["state_hash"], read_summary(folder.path() / "second")["state_hash"]);
}

TEST(RunCase, a_stop_request_ends_with_what_there_is) {
  const TemporaryFolder folder;
  volatile std::sig_atomic_t stop = 1;
  RunOptions options;
  options.out = folder.path() / "stopped";
  options.stop = &stop;
  const RunResult r = run_case(read_case(case_path(kSilo), kSmall), options);
  EXPECT_EQ(r.status, RunStatus::interrupted);
  EXPECT_EQ(read_summary(options.out)["status"], "interrupted");
  EXPECT_TRUE(std::filesystem::exists(options.out / "particles.vtp"));
}

TEST(RunCase, a_particle_that_leaves_the_domain_fails_the_run) {
  const TemporaryFolder folder;
  const auto out = folder.path() / "hole";
  auto overrides = kSmall;
  overrides.push_back("outlet.orifice.remove_beyond=1");  // never taken out, so it falls through the domain's floor
  overrides.push_back("stage.drain.max_time=0.5");
  const RunResult r = run_to(out, kSilo, overrides);
  EXPECT_EQ(r.status, RunStatus::failed);
  EXPECT_NE(r.message.find("left the domain"), std::string::npos) << r.message;
  EXPECT_EQ(read_summary(out)["status"], "failed");
}

TEST(RunCase, a_region_too_small_for_its_fill_is_refused) {
  const TemporaryFolder folder;
  const RunResult r = run_to(folder.path() / "full", kSilo, kTooDense);
  EXPECT_EQ(r.status, RunStatus::failed);
  EXPECT_NE(r.message.find("solid_fraction"), std::string::npos) << r.message;
}

TEST(RunCase, a_folder_that_cannot_be_made_fails_with_its_name) {
  const RunResult r = run_to("/proc/scree_results", kSilo, kSmall);
  EXPECT_EQ(r.status, RunStatus::failed);
  EXPECT_NE(r.message.find("/proc/scree_results"), std::string::npos) << r.message;
}

// ---- the command
// -----------------------------------------------------------------------------------------------------

int exit_code_of(const std::string& arguments) {
  const int status = std::system((std::string(SCREE_COMMAND) + " " + arguments + " >/dev/null 2>&1").c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(Command, exit_codes) {
  const TemporaryFolder folder;
  const std::string good = case_path(kSilo), out = (folder.path() / "run").string();
  std::string too_dense;
  for (const std::string& o : kTooDense) too_dense += " --set " + o;
  EXPECT_EQ(exit_code_of("--help"), 0);
  EXPECT_EQ(exit_code_of("check " + good), 0);
  EXPECT_EQ(exit_code_of("check " + good + " --set stage.fill.mass=-1"), 2);
  EXPECT_EQ(exit_code_of("check " + good + " --set no.such.key=1"), 2);
  EXPECT_EQ(exit_code_of("check missing.toml"), 2);
  EXPECT_EQ(exit_code_of("frobnicate"), 2);
  EXPECT_EQ(exit_code_of("run " + good + " --threads 0"), 2);
  EXPECT_EQ(exit_code_of("run " + good + " --out " + out + too_dense), 3);
  EXPECT_EQ(exit_code_of("run " + good + " --out " + out), 2) << "the folder is not empty";
}

}  // namespace
}  // namespace scree
