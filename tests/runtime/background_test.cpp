// Jobs beside a run: in order, bounded, and no error is lost.
#include "runtime/background.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

namespace scree {
namespace {

TEST(Background, RunsAllJobsInTheirOrder) {
  Background background(2);
  std::vector<int> done;
  for (int k = 0; k < 100; ++k) background.submit([&, k] { done.push_back(k); });
  background.finish();
  ASSERT_EQ(done.size(), 100u);
  for (int k = 0; k < 100; ++k) EXPECT_EQ(done[static_cast<size_t>(k)], k);
}

TEST(Background, HoldsNoMoreThanTheJobThatRunsAndThoseThatMayWait) {
  Background background(1);
  std::atomic<int> held = 0, most = 0;
  for (int k = 0; k < 200; ++k) {
    background.submit([&] { --held; });
    most = std::max(most.load(), ++held);
  }
  background.finish();
  EXPECT_EQ(held, 0);
  EXPECT_LE(most, 3);  // a job that has ended may not have counted down when the next is counted
}

TEST(Background, ThrowsAJobsErrorAtTheNextCallAndDropsTheJobsBehindIt) {
  Background background(1);
  bool ran_behind = false;
  background.submit([] { throw std::runtime_error("full"); });
  try {
    background.submit([&] { ran_behind = true; });
    background.finish();
    FAIL() << "the error was lost";
  } catch (const std::runtime_error& e) {
    EXPECT_STREQ(e.what(), "full");
  }
  EXPECT_FALSE(ran_behind);
  bool ran_later = false;
  background.submit([&] { ran_later = true; });
  EXPECT_NO_THROW(background.finish());
  EXPECT_TRUE(ran_later);
}

// Long enough to see that a job has not begun, too short to matter to one that waits for hours.
constexpr std::chrono::milliseconds kAMoment{20};

TEST(Background, LetsAPatientJobWaitUntilItIsToldToBegin) {
  std::atomic<int> done = 0;
  Background background(1);
  for (const bool finish : {false, true}) {
    done = 0;
    background.submit([&] { ++done; }, std::chrono::hours{1});
    std::this_thread::sleep_for(kAMoment);
    EXPECT_EQ(done, 0);
    finish ? background.finish() : background.begin();
    while (done == 0) std::this_thread::yield();
  }
  done = 0;
  background.submit([&] { ++done; }, std::chrono::hours{1});
  background.submit([&] { ++done; }, std::chrono::hours{1});  // one may wait: the first begins
  while (done < 1) std::this_thread::yield();
  std::this_thread::sleep_for(kAMoment);
  EXPECT_EQ(done, 1);
}

TEST(Background, BeginsAPatientJobByItselfInTheEnd) {
  std::atomic<int> done = 0;
  Background background(1);
  background.submit([&] { ++done; }, std::chrono::milliseconds{1});
  while (done == 0) std::this_thread::yield();
}

TEST(Background, LetsTheCallerRunWhatHasPatience) {
  Background background(2);
  background.run_patient();  // nothing
  std::vector<bool> beside;
  const auto note = [&] { beside.push_back(background.is_this_thread()); };
  background.submit(note, std::chrono::hours{1});
  background.run_patient();
  ASSERT_EQ(beside, std::vector<bool>{false});
  background.submit(note);
  background.finish();
  EXPECT_EQ(beside, (std::vector<bool>{false, true}));
  background.submit([] { throw std::runtime_error("full"); }, std::chrono::hours{1});
  EXPECT_NO_THROW(background.run_patient());
  EXPECT_THROW(background.finish(), std::runtime_error);
}

TEST(Background, LeavesAJobToWhoBeganIt) {
  Background background(1);
  std::atomic<bool> begun = false, may_end = false;
  std::atomic<int> done = 0;
  background.submit([&] {
    begun = true;
    while (!may_end) std::this_thread::yield();
    ++done;
  });
  while (!begun) std::this_thread::yield();
  background.submit([&] { ++done; }, std::chrono::hours{1});
  background.run_patient();  // does not wait, either: the jobs' order would not be kept
  EXPECT_EQ(done, 0);
  may_end = true;
  background.finish();
  EXPECT_EQ(done, 2);
}

TEST(Background, FinishesItsJobsBeforeItGoes) {
  int done = 0;
  {
    Background background(1);
    for (int k = 0; k < 5; ++k) background.submit([&] { ++done; });
    background.submit([&] { ++done; }, std::chrono::hours{1});
  }
  EXPECT_EQ(done, 6);
}

}  // namespace
}  // namespace scree
