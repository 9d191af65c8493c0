// Checkpoints of a small run through every kind of stage, made once when a fuzzer starts.
#pragma once

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "runtime/case_reader.h"
#include "runtime/checkpoint.h"
#include "runtime/simulation.h"

namespace scree::fuzz {

inline constexpr const char* kSmallRun = R"(
base = "common_box.toml"
time = {rayleigh_fraction = 0.3}
checkpoint = {interval = 1e-9, keep = 1000}
neighbour = {skin = 2e-4}
[domain]
min = [-10e-3, -10e-3, -10e-3]
max = [10e-3, 10e-3, 40e-3]
[[particles]]
name = "bead"
material = "glass"
diameter = 1.5e-3
[[wall]]
name = "box"
open_faces = ["bottom"]
[[wall]]
name = "lid"
material = "steel"
kind = "rectangle"
min = [-10e-3, -10e-3, 0]
max = [10e-3, 10e-3, 0]
[[fibres]]
name = "fibre"
material = "steel"
diameter = 1e-3
segments = [[-10e-3, 0, 6e-3, 10e-3, 0, 6e-3], [0, 0, 6e-3, 0, 10e-3, 6e-3]]
[[region]]
name = "low"
shape = "box"
min = [-4e-3, -4e-3, 0.2e-3]
max = [4e-3, 4e-3, 5e-3]
[[region]]
name = "high"
shape = "box"
min = [-9e-3, -9e-3, 20e-3]
max = [9e-3, 9e-3, 39e-3]
[[outlet]]
name = "exit"
point = [0, 0, 0]
remove_beyond = 1e-5
[[meter]]
name = "low"
min = [-10e-3, -10e-3, 0]
max = [10e-3, 10e-3, 20e-3]
[output]
interval = 1e-4
[output.touch]
cell = 5e-3
around = 4
[output.residence]
enabled = true
entry = 15e-3
exit = 1e-3
[[output.average]]
name = "box"
min = [-10e-3, -10e-3, 0]
max = [10e-3, 10e-3, 20e-3]
spacing = 5e-3
width = 5e-3
during = "always"
interval = 1e-3
[[stage]]
kind = "fill"
regions = ["low"]
count = 30
solid_fraction = 0.3
velocity = [0, 0, -0.3]
[[stage]]
kind = "pour"
region = "high"
rate = 1
mass = 3e-5
velocity = [0, 0, -0.4]
[[stage]]
kind = "settle"
time = 2e-3
[[stage]]
kind = "open"
walls = ["lid"]
[[stage]]
kind = "drain"
max_time = 4e-3
)";

// Removes the folder at the end of the process.
class Folder {
 public:
  Folder() : path_(std::filesystem::temp_directory_path() / ("scree_fuzz_" + std::to_string(getpid()))) {
    std::filesystem::remove_all(path_);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

struct SmallRun {
  Folder folder;
  Case c;
  std::vector<std::filesystem::path> checkpoints;  // oldest first

  SmallRun() : c(read_case_text(kSmallRun, std::string(SCREE_FUZZ_FILES) + "/small_run.toml")) {
    RunOptions options;
    options.out = folder.path();
    options.threads = 1;
    const RunResult result = run_case(c, options);
    checkpoints = Checkpoints(folder.path(), 0).newest_first();
    std::ranges::reverse(checkpoints);
    if (result.status == RunStatus::done && checkpoints.size() >= 5) return;
    std::fprintf(stderr, "the small run failed: %s\n", result.message.c_str());
    std::abort();
  }
};

}  // namespace scree::fuzz
