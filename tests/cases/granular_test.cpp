// What granular matter is known to do: Beverloo's law of discharge, piles that steepen with rolling friction.
#include <cmath>

#include "tests/cases/case_runs.h"
#include "tests/length.h"

namespace scree {
namespace {

constexpr double kBead = 1e-3;  // m

// Steady discharge of the example silo, made small: 9 mm wide, `mass` of 1 mm beads, an orifice of `diameter`.
SteadyFlow silo_discharge(double diameter, double mass) {
  const TemporaryFolder folder;
  const auto out = folder.path() / "silo";
  const auto set = [](const std::string& key, double value) { return key + "=" + std::to_string(value); };
  const RunResult r = run_to(
      out, "examples/orifice_silo.toml",
      {set("wall.box.radius", 0.009), set("wall.bottom.outer_radius", 0.009), set("region.inside.radius", 0.0084),
       set("wall.bottom.inner_radius", diameter / 2), set("wall.plug.radius", diameter / 2),
       set("stage.fill.mass", mass), "time.rayleigh_fraction=0.3", set("stage.settle.time", length(0.08, 0.004)),
       set("stage.drain.discharged_fraction", length(0.5, 0.02))});
  EXPECT_EQ(r.status, RunStatus::done) << r.message;
  EXPECT_TRUE(r.steady.has_value() || shortened()) << "no plateau for an orifice of " << diameter << " m";
  return r.steady.value_or(SteadyFlow{});
}

TEST(Beverloo, discharge_scales_with_the_orifice_to_the_power_five_halves) {
  // W = C rho sqrt(g) (D - k d)^(5/2), k = 1.4 for spheres (Beverloo et al. 1961; Nedderman 1992).
  const double k = 1.4;
  const std::vector<double> diameters{6e-3, 7.5e-3, 9e-3};
  double mean_x = 0, mean_y = 0, sxy = 0, sxx = 0;
  std::vector<std::pair<double, double>> points;
  for (double d : diameters) points.push_back({std::log(d - k * kBead), std::log(silo_discharge(d, 9e-3).rate)});
  for (auto [x, y] : points) mean_x += x / points.size(), mean_y += y / points.size();
  for (auto [x, y] : points) sxy += (x - mean_x) * (y - mean_y), sxx += (x - mean_x) * (x - mean_x);
  std::printf("exponent %.2f\n", sxy / sxx);
  if (shortened()) return;  // no steady flow yet
  EXPECT_NEAR(sxy / sxx, 2.5, 0.3);
}

TEST(Beverloo, discharge_does_not_depend_on_the_height_of_the_fill) {
  const SteadyFlow low = silo_discharge(7.5e-3, 6e-3), high = silo_discharge(7.5e-3, 12e-3);
  std::printf("6 g: %.3f +- %.3f g/s, 12 g: %.3f +- %.3f g/s\n", 1e3 * low.rate, 1e3 * low.standard_error,
              1e3 * high.rate, 1e3 * high.standard_error);
  if (shortened()) return;
  EXPECT_NEAR(high.rate / low.rate, 1, 0.1);  // a liquid's would grow by the root of two
}

double mass_kept_on_plate(double rolling_friction, int seed) {
  const TemporaryFolder folder;
  const auto out = folder.path() / "pile";
  const RunResult r = run_to(
      out, "examples/angle_of_repose.toml",
      {"pair.glass+glass.rolling_friction=" + std::to_string(rolling_friction), "pair.glass+glass.sliding_friction=0.5",
       "pair.glass+steel.sliding_friction=0.5", "time.rayleigh_fraction=0.3", "seed=" + std::to_string(seed),
       "stage.pour.mass=" + std::to_string(length(12e-3, 1e-3)),
       "stage.settle.max_time=" + std::to_string(length(0.5, 0.005))});
  EXPECT_EQ(r.status, RunStatus::done) << r.message;
  return read_summary(out)["mass_retained_kg"];
}

TEST(AngleOfRepose, grows_with_rolling_friction) {
  // A cone on a plate of fixed radius: the mass that stays measures the slope's tangent. Seeds scatter by about 1.5 %.
  double most_low = 0, least_high = 1;
  for (const int seed : {1, 2}) {
    const double low = mass_kept_on_plate(0.01, seed), high = mass_kept_on_plate(0.3, seed);
    std::printf("seed %d: kept on the plate: %.3f g at 0.01, %.3f g at 0.3\n", seed, 1e3 * low, 1e3 * high);
    if (shortened()) return;  // some on the plate, no pile
    most_low = std::max(most_low, low), least_high = std::min(least_high, high);
  }
  EXPECT_GT(least_high, 1.05 * most_low);
}

}  // namespace
}  // namespace scree
