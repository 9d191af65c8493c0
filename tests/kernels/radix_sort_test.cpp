#include "kernels/radix_sort.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "kernels/parallel.h"

namespace scree {
namespace {

using Packed = std::vector<uint64_t>;
enum class Order { random, few_codes, all_equal, sorted, reversed };

Packed make(size_t count, Order order, int bits) {
  std::mt19937 random(static_cast<uint32_t>(count) + 1);
  Packed packed(count);
  const uint64_t most = (uint64_t{1} << bits) - 1;
  for (size_t k = 0; k < count; ++k) {
    uint64_t code = 0;
    switch (order) {
      case Order::random:
        code = random() & most;
        break;
      case Order::few_codes:
        code = (random() % 7) * (most / 7);
        break;
      case Order::all_equal:
        code = most / 3;
        break;
      case Order::sorted:
        code = k * most / count;
        break;
      case Order::reversed:
        code = (count - k) * most / count;
        break;
    }
    packed[k] = code << 32 | k;
  }
  return packed;
}

class RadixSort : public ::testing::TestWithParam<int> {
 protected:
  void SetUp() override { set_thread_count(GetParam()); }
  void TearDown() override { set_thread_count(before_); }

 private:
  int before_ = thread_count();
};

// Equal codes keep their order: the index below the code rises.
TEST_P(RadixSort, GivesTheOneStableOrder) {
  for (const size_t count : {0, 1, 2, 4095, 4096, 4097, 8193, 100000})
    for (const Order order : {Order::random, Order::few_codes, Order::all_equal, Order::sorted, Order::reversed})
      for (const int bits : {1, 8, 9, 24, 31}) {
        Packed packed = make(count, order, bits), expected = packed, scratch;
        std::ranges::stable_sort(expected, {}, [](uint64_t p) { return p >> 32; });
        radix_sort(packed, scratch, bits);
        ASSERT_TRUE(packed == expected) << count << " of order " << static_cast<int>(order) << ", " << bits << " bits";
      }
}

TEST_P(RadixSort, SortsAMillion) {
  Packed packed = make(1000000, Order::random, 29), expected = packed, scratch;
  std::ranges::stable_sort(expected);
  radix_sort(packed, scratch, 29);
  EXPECT_TRUE(packed == expected);
}

TEST_P(RadixSort, OfNoBitsLeavesTheOrderAlone) {
  Packed packed = make(5000, Order::random, 20), scratch;
  const Packed before = packed;
  radix_sort(packed, scratch, 0);
  EXPECT_TRUE(packed == before);
}

// Stability is tested with indices that fall as well: what arrives first stays first.
TEST_P(RadixSort, KeepsTheOrderOfArrivalNotOfIndices) {
  Packed packed, scratch;
  for (uint64_t k = 0; k < 20000; ++k) packed.push_back((k * 7919 % 13) << 32 | (20000 - k));
  Packed expected = packed;
  std::ranges::stable_sort(expected, {}, [](uint64_t p) { return p >> 32; });
  radix_sort(packed, scratch, 4);
  EXPECT_TRUE(packed == expected);
}

INSTANTIATE_TEST_SUITE_P(Threads, RadixSort, ::testing::Values(1, 2, 3, 8));

}  // namespace
}  // namespace scree
