// What is spread over a grid stays as much as it was, in the same place, with the kernel's width.
#include "kernels/coarse_grain.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "kernels/parallel.h"

namespace scree {
namespace {

using Sample = CoarseSample<kStressValues>;

CoarseGrid some_grid() { return {{-0.01, 0.002, 0}, {1e-3, 1.1e-3, 0.9e-3}, {14, 9, 21}, 2.3e-3, {}}; }

Vec3 edges(const CoarseGrid& g) {
  return {g.spacing.x * g.cells[0], g.spacing.y * g.cells[1], g.spacing.z * g.cells[2]};
}

// In the grid's box, and a tenth of its size beyond it on each side.
std::vector<Sample> samples_about(const CoarseGrid& g, size_t count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-0.1, 1.1), value(-1, 1);
  std::vector<Sample> samples(count);
  for (Sample& s : samples) {
    const Vec3 e = edges(g);
    s.x = g.origin + Vec3{place(random) * e.x, place(random) * e.y, place(random) * e.z};
    for (double& v : s.values) v = value(random);
  }
  return samples;
}

std::vector<double> spread(const CoarseGrid& g, const std::vector<Sample>& samples) {
  std::vector<double> sums(g.size() * kStressValues, 0.0);
  deposit<kStressValues>(g, samples, sums);
  return sums;
}

double total(const std::vector<double>& sums, size_t n) {
  double sum = 0;
  for (size_t k = n; k < sums.size(); k += kStressValues) sum += sums[k];
  return sum;
}

TEST(CoarseGrain, CellsSumUpToTheSamplesInsideAndNothingElse) {
  const CoarseGrid g = some_grid();
  const std::vector<Sample> samples = samples_about(g, 500);
  const std::vector<double> sums = spread(g, samples);
  size_t outside = 0;
  for (size_t n = 0; n < kStressValues; ++n) {
    double expected = 0;
    for (const Sample& s : samples) g.holds(s.x) ? expected += s.values[n] : double(++outside);
    EXPECT_NEAR(total(sums, n), expected, 1e-11);
  }
  EXPECT_GT(outside, 100u);
}

TEST(CoarseGrain, ASampleBesideAFaceKeepsAllItHas) {
  const CoarseGrid g = some_grid();
  for (const double share : {0.0, 1e-9, 0.5, 1.0 - 1e-9, 1.0}) {
    const Vec3 e = edges(g);
    const std::vector<double> sums = spread(g, {{g.origin + Vec3{share * e.x, share * e.y, share * e.z}, {3}}});
    EXPECT_NEAR(total(sums, 0), 3, 1e-14) << share;
  }
}

TEST(CoarseGrain, NothingReachesBeyondTheKernelsWidth) {
  const CoarseGrid g = some_grid();
  const Vec3 x{-0.0031, 0.0072, 0.0093};
  const std::vector<double> sums = spread(g, {{x, {1}}});
  for (size_t cell = 0; cell < g.size(); ++cell) {
    const Vec3 d = g.centre(cell) - x;
    const bool near = std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)}) < g.width;
    EXPECT_EQ(sums[cell * kStressValues] > 0, near);
  }
}

// Over places at random within a cell, far from the faces, the shares have the kernel's mean and variance.
TEST(CoarseGrain, SharesHaveTheMeanAndVarianceOfTheKernel) {
  const CoarseGrid g{{0, 0, 0}, {1, 1, 1}, {13, 13, 13}, 2.5, {}};
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(6, 7);
  double variance = 0, mean = 0;
  constexpr int kCount = 150;
  for (int k = 0; k < kCount; ++k) {
    const Vec3 x{place(random), place(random), place(random)};
    const std::vector<double> sums = spread(g, {{x, {1}}});
    for (size_t cell = 0; cell < g.size(); ++cell) {
      const Vec3 d = g.centre(cell) - x;
      mean += sums[cell * kStressValues] * (d.x + d.y + d.z) / (3 * kCount);
      variance += sums[cell * kStressValues] * dot(d, d) / (3 * kCount);
    }
  }
  EXPECT_NEAR(mean, 0, 0.01 * g.width);
  EXPECT_NEAR(variance / kernel_variance(g), 1, 0.02);
}

TEST(CoarseGrain, APeriodOnIsTheSamePlace) {
  CoarseGrid g = some_grid();
  for (bool& w : g.wrap) w = true;
  const Vec3 e = edges(g);
  std::vector<Sample> samples = samples_about(g, 50);
  const std::vector<double> here = spread(g, samples);
  for (Sample& s : samples) s.x += Vec3{e.x, -2 * e.y, e.z};
  const std::vector<double> there = spread(g, samples);
  for (size_t k = 0; k < here.size(); ++k) ASSERT_NEAR(here[k], there[k], 1e-12);
  double expected = 0;
  for (const Sample& s : samples) expected += s.values[0];
  EXPECT_NEAR(total(here, 0), expected, 1e-12);
}

TEST(CoarseGrain, IsTheSameForAnyNumberOfThreads) {
  const CoarseGrid g = some_grid();
  const std::vector<Sample> samples = samples_about(g, 3000);
  const int before = thread_count();
  set_thread_count(1);
  const std::vector<double> one = spread(g, samples);
  set_thread_count(3);
  const std::vector<double> three = spread(g, samples);
  set_thread_count(before);
  EXPECT_EQ(one, three);
}

TEST(CoarseGrain, ACellHoldsItsCentre) {
  const CoarseGrid g = some_grid();
  for (size_t cell = 0; cell < g.size(); ++cell) ASSERT_EQ(g.cell_of(g.centre(cell)), cell);
}

}  // namespace
}  // namespace scree
