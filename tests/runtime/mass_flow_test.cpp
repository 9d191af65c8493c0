// The steady part of a discharge curve.
#include "runtime/mass_flow.h"

#include <gtest/gtest.h>

#include <cmath>

namespace scree {
namespace {

struct Spell {
  double until, rate;  // s, kg/s
};

// Samples each ms of what flows at the given rates, one after the other.
std::vector<FlowSample> discharge(const std::vector<Spell>& spells) {
  std::vector<FlowSample> samples = {{0, {0.0}}};
  for (const Spell& spell : spells)
    while (samples.back().time < spell.until - 1e-9)
      samples.push_back({samples.back().time + 1e-3, {samples.back().total() + spell.rate * 1e-3}});
  return samples;
}

constexpr double kSurge = 0.07;  // s that one may last

SteadyFlow found_in(const std::vector<FlowSample>& samples, double to) {
  return find_steady_flow(samples, 0, to, kSurge).value_or(SteadyFlow{});
}

const Spell kGush = {0.03, 11e-3}, kPlateau = {0.3, 8e-3};

TEST(SteadyFlow, IsThePlateauAfterTheSurge) {
  const SteadyFlow steady = found_in(discharge({kGush, kPlateau, {0.4, 2e-3}}), 0.4);
  EXPECT_NEAR(steady.rate, 8e-3, 0.1e-3);
  EXPECT_NEAR(steady.from, 0.03, 0.02);
  EXPECT_NEAR(steady.to, 0.3, 0.02);
}

// Within 8 %, and yet a surge: it goes on for a quarter of the window.
TEST(SteadyFlow, LeavesOutASurgeThatIsAsEvenAsAPlateau) {
  std::vector<Spell> spells;
  for (int k = 0; k < 400; ++k) {
    const double time = 1e-3 * (k + 1), scatter = k % 3 == 0 ? 0.1e-3 : k % 3 == 1 ? -0.1e-3 : 0;
    spells.push_back({time, 8e-3 + 0.6e-3 * std::exp(-time / 0.04) + scatter});
  }
  const SteadyFlow steady = found_in(discharge(spells), 0.4);
  EXPECT_NEAR(steady.rate, 8e-3, 0.01e-3);
  EXPECT_GT(steady.from, 0.08);
  EXPECT_LE(steady.from, 0.2);
  EXPECT_NEAR(steady.to, 0.4, 1e-9);
}

TEST(SteadyFlow, IsNotTheSurgeOfADrainThatWasCutShort) {
  const auto samples = discharge({kGush, {0.05, 8e-3}});
  EXPECT_FALSE(find_steady_flow(samples, 0, 0.05, kSurge));
  ASSERT_TRUE(find_steady_flow(samples, 0, 0.05, 0)) << "as even as a plateau, only too short";
}

TEST(SteadyFlow, IsNothingWhereTheFlowOnlyFalls) {
  std::vector<Spell> spells;
  for (int k = 0; k < 40; ++k) spells.push_back({0.01 * (k + 1), 10e-3 * std::exp(-0.15 * k)});
  EXPECT_FALSE(find_steady_flow(discharge(spells), 0, 0.4, kSurge));
}

TEST(SteadyFlow, OfAWindowByNameIsTheSlopeBetweenItsEnds) {
  const SteadyFlow steady = steady_flow_in(discharge({kGush, kPlateau}), 0.01, 0.05).value_or(SteadyFlow{});
  EXPECT_NEAR(steady.rate, (0.02 * 11e-3 + 0.02 * 8e-3) / 0.04, 1e-12);
}

}  // namespace
}  // namespace scree
