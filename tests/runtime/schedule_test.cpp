#include "runtime/schedule.h"

#include <gtest/gtest.h>

namespace scree {
namespace {

constexpr double kDt = 5e-6;

std::vector<uint64_t> first_steps(const Schedule& s, size_t count) {
  std::vector<uint64_t> steps;
  for (uint64_t step = 0; steps.size() < count && (step = s.after(step)) != Schedule::kNever;) steps.push_back(step);
  return steps;
}

TEST(Schedule, intervals_count_from_the_beginning) {
  EXPECT_EQ(first_steps(Schedule({.interval = 1e-3}, kDt), 3), (std::vector<uint64_t>{200, 400, 600}));
}

TEST(Schedule, intervals_keep_to_their_window) {
  EXPECT_EQ(first_steps(Schedule({.interval = 1e-3, .from = 2.5e-3, .to = 4.6e-3}, kDt), 9),
            (std::vector<uint64_t>{500, 700, 900}));
}

TEST(Schedule, single_moments_join_the_intervals) {
  EXPECT_EQ(first_steps(Schedule({.interval = 1e-3, .times = {1e-4, 1e-3, 1.5e-3}, .to = 2e-3}, kDt), 9),
            (std::vector<uint64_t>{20, 200, 300, 400}));
}

TEST(Schedule, nothing_asked_for_is_never_due) {
  EXPECT_EQ(Schedule({.stage_ends = true}, kDt).after(0), Schedule::kNever);
  EXPECT_TRUE(Schedule({.stage_ends = true}, kDt).stage_ends());
}

TEST(Schedule, does_not_depend_on_where_a_run_was_resumed) {
  const Schedule s({.interval = 7e-4, .times = {1.23e-3}}, kDt);
  for (uint64_t step = 0; step < 2000; ++step) {
    const uint64_t next = s.after(step);
    for (uint64_t between = step; between < next; ++between) ASSERT_EQ(s.after(between), next);
  }
}

}  // namespace
}  // namespace scree
