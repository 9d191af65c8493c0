// A bed that was placed at once and relaxed is the bed that pouring makes, only sooner.
#include <cmath>
#include <numbers>

#include "runtime/vtkhdf_reader.h"
#include "tests/cases/case_runs.h"
#include "tests/length.h"

namespace scree {
namespace {

constexpr double kSide = 6e-3, kRadius = 2e-4;                       // m; periodic sideways
constexpr double kSlab[2] = {1.5e-3, 5e-3};                          // m above the floor: away from floor and surface
const int kGrains = length(4400, 1500);                              // some 7 mm high
constexpr double kPourRate = 0.2 / (60e-3 * 20e-3) * kSide * kSide;  // kg/s, the paper's pour on this area

struct Bed {
  double solid_fraction, coordination;
};

// Volume of a sphere's part between two heights.
double volume_between(double z, double low, double high) {
  const double a = std::clamp(low - z, -kRadius, kRadius), b = std::clamp(high - z, -kRadius, kRadius);
  return std::numbers::pi * (kRadius * kRadius * (b - a) - (b * b * b - a * a * a) / 3);
}

Bed bed_in(const std::filesystem::path& frame) {
  VtkHdfReader file(frame);
  const auto points = file.read("Points"), coordination = file.read("PointData/coordination");
  Bed bed{0, 0};
  int inside = 0;
  for (uint64_t k = 0; k < points.count; ++k) {
    const double z = points.values[3 * k + 2];
    bed.solid_fraction += volume_between(z, kSlab[0], kSlab[1]) / (kSide * kSide * (kSlab[1] - kSlab[0]));
    if (z > kSlab[0] && z < kSlab[1]) bed.coordination += coordination.values[k], ++inside;
  }
  bed.coordination /= inside;
  return bed;
}

// The paper's grains (cases/olhx/common.toml) above a floor: `start` is the stage that brings them into the room
// between two heights, then 0.1 s to settle.
Bed settled_bed(const std::string& start, double low, double high) {
  const TemporaryFolder folder;
  const auto text = fmt::format(R"(base = "{base}"
title = "bed"
[domain]
min = [-{half}, -{half}, -1e-3]
max = [{half}, {half}, 40e-3]
periodic = ["x", "y"]
[[wall]]
name = "floor"
material = "steel"
kind = "rectangle"
min = [-{half}, -{half}, 0]
max = [{half}, {half}, 0]
[[region]]
name = "room"
shape = "box"
min = [-{half}, -{half}, {low}]
max = [{half}, {half}, {high}]
[[stage]]
{start}
count = {grains}
[[stage]]
kind = "settle"
time = {settle}
)",
                                fmt::arg("base", case_path("olhx/common.toml")), fmt::arg("half", kSide / 2),
                                fmt::arg("low", low), fmt::arg("high", high), fmt::arg("start", start),
                                fmt::arg("grains", kGrains), fmt::arg("settle", length(0.1, 0.005)));
  const auto path = folder.path() / "bed.toml";
  std::ofstream(path) << text;
  RunOptions options;
  options.out = folder.path() / "bed";
  const RunResult r = run_case(read_case(path.string()), options);
  EXPECT_EQ(r.status, RunStatus::done) << r.message;
  std::filesystem::path last;
  for (const auto& entry : std::filesystem::directory_iterator(options.out / "fields"))
    if (entry.path().filename().string().starts_with("particles_") && entry.path() > last) last = entry.path();
  return bed_in(last);
}

TEST(DirectStart, settles_to_the_solid_fraction_and_coordination_of_a_poured_bed) {
  // Placed at 0.56. At 0.5 the bed settles to 0.534 with 3.96 contacts: looser than a poured one.
  const double fraction = 0.56;
  const double height = kGrains * 4 / 3.0 * std::numbers::pi * std::pow(kRadius, 3) / (fraction * kSide * kSide);
  const Bed placed = settled_bed(fmt::format("kind = \"fill\"\nregions = [\"room\"]\nsolid_fraction = {}", fraction),
                                 0.1e-3, 0.1e-3 + 1.01 * height);
  const Bed poured = settled_bed(
      fmt::format("kind = \"pour\"\nregion = \"room\"\nrate = {}\nvelocity = [0, 0, -0.5]", kPourRate), 30e-3, 36e-3);
  std::printf("solid fraction %.4f placed, %.4f poured; coordination %.3f, %.3f\n", placed.solid_fraction,
              poured.solid_fraction, placed.coordination, poured.coordination);
  if (shortened()) return;
  EXPECT_NEAR(placed.solid_fraction, poured.solid_fraction, 0.01);
  EXPECT_NEAR(placed.coordination, poured.coordination, 0.15);
}

}  // namespace
}  // namespace scree
