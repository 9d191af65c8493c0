// The small Octet lattice that LIGGGHTS 3.8 drained (cases/olhx/reference/README.md): same start, same law, same curve.
//
// LIGGGHTS's fibres are tubes of flat faces, ours are round. The rounder its tubes, the nearer its curve is to ours: on
// tubes of 28 sides the two agree within what its runs on one mesh differ by (0.27 g/s in the inflow, 0.03 g in the
// lattice); tubes of 14 sides hold back up to an eighth of the outflow.
#include "tests/cases/case_runs.h"
#include "tests/length.h"

namespace scree {
namespace {

double slope(const std::vector<double>& t, const std::vector<double>& y, double from, double to) {
  return (value_at(t, y, to) - value_at(t, y, from)) / (to - from);
}

struct Curve {
  std::vector<double> t, in_lattice, above_exit;  // s after the lid opened; kg

  double inflow() const { return slope(t, in_lattice, 0.05, 0.125); }
  double outflow() const { return -slope(t, above_exit, 0.37, 0.5); }
};

Curve liggghts(const std::string& file) {
  const Table table = read_table(case_path("olhx/reference/" + file));
  return {table.column("t_s"), table.column("mass_in_lattice_kg"), table.column("mass_above_exit_kg")};
}

double largest_difference(const Curve& a, const Curve& b, std::vector<double> Curve::*what) {
  double worst = 0;
  for (size_t k = 0; k < b.t.size(); ++k)
    worst = std::max(worst, std::abs(value_at(a.t, a.*what, b.t[k]) - (b.*what)[k]));
  return worst;
}

struct Agreement {
  double inflow, outflow, in_lattice, above_exit;  // kg/s, kg
};

void expect_agreement(const Curve& ours, const std::string& file, const Agreement& within) {
  const Curve theirs = liggghts(file);
  const double in_lattice = largest_difference(ours, theirs, &Curve::in_lattice);
  const double above_exit = largest_difference(ours, theirs, &Curve::above_exit);
  std::printf(
      "%s: inflow %.3f g/s (LIGGGHTS %.3f), outflow %.3f g/s (%.3f); largest difference in the lattice %.3f g, "
      "above the exit %.3f g\n",
      file.c_str(), 1e3 * ours.inflow(), 1e3 * theirs.inflow(), 1e3 * ours.outflow(), 1e3 * theirs.outflow(),
      1e3 * in_lattice, 1e3 * above_exit);
  EXPECT_NEAR(ours.inflow(), theirs.inflow(), within.inflow) << file;
  EXPECT_NEAR(ours.outflow(), theirs.outflow(), within.outflow) << file;
  EXPECT_LT(in_lattice, within.in_lattice) << file;
  EXPECT_LT(above_exit, within.above_exit) << file;
}

TEST(Liggghts, small_octet_lattice_drains_alike) {
  const TemporaryFolder folder;
  const auto out = folder.path() / "mini";
  const RunResult result = run_to(out, "olhx/mini_liggghts.toml",
                                  {"stage.settle.time=" + std::to_string(length(0.01, 0.001)),
                                   "stage.drain.max_time=" + std::to_string(length(0.5, 0.002))});
  ASSERT_EQ(result.status, RunStatus::done) << result.message;
  if (shortened()) return;  // the lid has hardly opened
  const Table table = read_table(out / "meters.csv");
  Curve ours{table.column("time_s"), table.column("lattice_kg"), table.column("above_exit_kg")};
  for (double& time : ours.t) time -= 0.01;  // the lid opens at 0.01 s

  // 3 g in the run, 2.2 g at most in the lattice; the slopes' 0.3 g/s is the scatter that the reference states.
  expect_agreement(ours, "drain_liggghts_28_sides.csv", {0.3e-3, 0.3e-3, 0.04e-3, 0.03e-3});
  // Coarser tubes: LIGGGHTS itself differs by this much between 14 and 28 sides.
  expect_agreement(ours, "drain_liggghts.csv", {0.4e-3, 0.6e-3, 0.15e-3, 0.15e-3});
}

}  // namespace
}  // namespace scree
