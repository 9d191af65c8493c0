// A discharge in mixed and in double precision, alike within what chance makes of it. Three seeds each; the bounds are
// Student's, from the scatter over seeds.
#include <cmath>

#include "tests/cases/case_runs.h"
#include "tests/length.h"

namespace scree {
namespace {

constexpr int kSeeds = 3;

double mean(const std::vector<double>& x) {
  double sum = 0;
  for (const double v : x) sum += v;
  return sum / static_cast<double>(x.size());
}

// Of two samples of kSeeds together, about their own means.
double pooled_deviation(const std::vector<double>& a, const std::vector<double>& b) {
  double squares = 0;
  for (const auto* x : {&a, &b})
    for (const double v : *x) squares += (v - mean(*x)) * (v - mean(*x));
  return std::sqrt(squares / (2 * (kSeeds - 1)));
}

// The difference of two means of kSeeds that chance exceeds once in a hundred times: Student's t of 4 degrees of
// freedom.
double chance(const std::vector<double>& a, const std::vector<double>& b) {
  constexpr double kStudent = 4.604;
  return kStudent * pooled_deviation(a, b) * std::sqrt(2.0 / kSeeds);
}

void expect_alike(const char* what, const std::vector<double>& a, const std::vector<double>& b) {
  std::printf("%s: %.5g against %.5g, scatter %.2g, difference %.2g, by chance up to %.2g\n", what, mean(a), mean(b),
              pooled_deviation(a, b), mean(a) - mean(b), chance(a, b));
  EXPECT_GT(pooled_deviation(a, b), 0) << what << ": the seeds do nothing";
  EXPECT_LE(std::abs(mean(a) - mean(b)), chance(a, b)) << what;
}

// ---- a discharge in both precisions

struct Discharge {
  double rate = 0;     // g/s, between 15 and 45 % of the mass
  double quarter = 0;  // s after the opening until a quarter of the mass is out
};

constexpr double kSiloMass = 3e-3, kSettled = 0.08;  // kg, s

Discharge discharge(const std::string& precision, int seed) {
  const TemporaryFolder folder;
  const auto out = folder.path() / "silo";
  const RunResult r =
      run_to(out, "examples/orifice_silo.toml",
             {"wall.box.radius=0.009", "wall.bottom.outer_radius=0.009", "region.inside.radius=0.0084",
              "wall.bottom.inner_radius=3.75e-3", "wall.plug.radius=3.75e-3", "stage.fill.mass=3e-3",
              "time.rayleigh_fraction=0.3", "stage.settle.time=" + std::to_string(length(kSettled, 0.004)),
              "stage.drain.discharged_fraction=" + std::to_string(length(0.5, 0.02)), "output.interval=1e-3",
              "checkpoint.keep=0", "contact.precision=" + precision, "seed=" + std::to_string(seed)});
  EXPECT_EQ(r.status, RunStatus::done) << r.message;
  const Table flow = read_table(out / "mass_flow.csv");
  const std::vector<double> t = flow.column("time_s"), m = flow.column("discharged_kg");
  const auto time_of = [&](double mass) {
    size_t k = 1;
    while (k + 1 < m.size() && m[k] < mass) ++k;
    return t[k - 1] + (t[k] - t[k - 1]) * (mass - m[k - 1]) / (m[k] - m[k - 1]);
  };
  return {1e3 * 0.3 * kSiloMass / (time_of(0.45 * kSiloMass) - time_of(0.15 * kSiloMass)),
          time_of(0.25 * kSiloMass) - kSettled};
}

TEST(Precisions, discharge_alike) {
  std::vector<double> rate[2], quarter[2];
  for (int seed = 1; seed <= length(kSeeds, 1); ++seed)
    for (const int p : {0, 1}) {
      const Discharge d = discharge(p == 0 ? "mixed" : "reference", seed);
      rate[p].push_back(d.rate), quarter[p].push_back(d.quarter);
      std::printf("%s, seed %d: %.4f g/s, a quarter after %.4f s\n", p == 0 ? "mixed" : "double", seed, d.rate,
                  d.quarter);
    }
  if (shortened()) return;  // a quarter is not out yet
  expect_alike("discharge, g/s", rate[0], rate[1]);
  expect_alike("a quarter out, s", quarter[0], quarter[1]);
}

}  // namespace
}  // namespace scree
