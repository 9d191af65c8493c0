// A small case with a stage of every kind, two of which put particles among others that are in contact, and two meters;
// about a second. For tests of runs that stop and go on.
#pragma once

#include "runtime/checkpoint.h"
#include "runtime/run_state.h"
#include "tests/cases/case_runs.h"

namespace scree {

inline std::string write_every_stage(const std::filesystem::path& folder) {
  const std::string path = (folder / "every_stage.toml").string();
  std::ofstream(folder / "beads.csv") << "x, y, z, radius, vx, vy, vz\n"
                                         "0.001, 0.002, 0.033, 0.00075, 0, 0, -0.3\n"
                                         "-0.004, 0.001, 0.034, 0.0006, 0, 0, 0\n";
  std::ofstream(path) << "base = \"" << case_path("examples/regions_and_stages.toml") << "\"\n"
                      << R"(
time = {rayleigh_fraction = 0.3}
output = {interval = 1e-3, energy_ledger = true}

[[meter]]
name = "upper_half"
min = [-10e-3, -10e-3, 20e-3]
max = [10e-3, 10e-3, 40e-3]

[[stage]]
kind = "fill"
regions = ["lower"]
count = 300
solid_fraction = 0.4

[[stage]]
kind = "settle"
name = "fall"
time = 0.008

[[stage]]
kind = "read"
file = "beads.csv"

[[stage]]
kind = "pour"
region = "upper"
rate = 0.1
mass = 0.6e-3
velocity = [0, 0, -0.4]
solid_fraction = 0.05

[[stage]]
kind = "settle"
kinetic_energy_per_particle = 1e-10
max_time = 0.01

[[stage]]
kind = "open"
walls = ["lid"]

[[stage]]
kind = "drain"
discharged_fraction = 0.9
max_time = 0.03
)";
  return path;
}

inline std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// What two runs of one case must leave alike, down to the last bit.
inline void expect_same_results(const std::filesystem::path& a, const std::filesystem::path& b) {
  EXPECT_EQ(text_of(a / "mass_flow.csv"), text_of(b / "mass_flow.csv"));
  EXPECT_EQ(text_of(a / "meters.csv"), text_of(b / "meters.csv"));
  EXPECT_EQ(text_of(a / "particles.vtp"), text_of(b / "particles.vtp"));
  const nlohmann::json one = read_summary(a), other = read_summary(b);
  for (const char* key : {"status", "state_hash", "steps", "rebuilds", "particle_steps", "particles", "particles_left",
                          "mass_discharged_kg", "mass_retained_kg", "stages", "lost_particles"})
    EXPECT_EQ(one.at(key), other.at(key)) << key;
  ASSERT_EQ(one.contains("energy"), other.contains("energy"));  // where the case asks for the ledger
  if (!one.contains("energy")) return;
  EXPECT_EQ(one["energy"], other["energy"]);
  EXPECT_TRUE(one["energy"]["closes"]) << one["energy"];
}

inline RunState run_state_of(const std::filesystem::path& checkpoint) {
  RunState state;
  Checkpoints::read(checkpoint, [&](StateReader& in) { in.load("run", state); });
  return state;
}

inline std::vector<std::filesystem::path> checkpoints_in(const std::filesystem::path& out) {
  return Checkpoints(out, 0).newest_first();
}

// A results folder as a run that died left it, its newest checkpoint being `checkpoint`.
inline void make_died_run(const std::filesystem::path& out, const std::filesystem::path& checkpoint) {
  std::filesystem::create_directories(out / "checkpoints");
  std::filesystem::copy(checkpoint, out / "checkpoints" / checkpoint.filename());
}

inline RunResult resume_in(const std::filesystem::path& out, const Case& c, int threads = 0) {
  RunOptions options;
  options.out = out, options.resume = true, options.threads = threads;
  return run_case(c, options);
}

}  // namespace scree
