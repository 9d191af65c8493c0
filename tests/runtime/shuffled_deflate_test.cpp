// The zlib streams of field files, undone by zlib; field_files_test.cpp has HDF5's and VTK's.
#include "runtime/shuffled_deflate.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <functional>
#include <numeric>
#include <random>
#include <span>
#include <vector>

namespace scree {
namespace {

std::vector<unsigned char> inflated(std::span<const unsigned char> stream, size_t bytes) {
  std::vector<unsigned char> result(std::max<size_t>(bytes, 1));
  uLongf got = result.size();
  EXPECT_EQ(uncompress(result.data(), &got, stream.data(), stream.size()), Z_OK);
  EXPECT_EQ(got, bytes);
  return result;
}

// Packs, undoes both filters, compares; returns the share of bytes that is left.
template <class T>
double packed_share(const std::vector<T>& values) {
  const auto stream = shuffled_deflate(reinterpret_cast<const unsigned char*>(values.data()), values.size(), sizeof(T));
  const auto shuffled = inflated(stream, values.size() * sizeof(T));
  std::vector<T> back(values.size());
  for (size_t k = 0; k < values.size(); ++k)
    for (size_t b = 0; b < sizeof(T); ++b)
      reinterpret_cast<unsigned char*>(&back[k])[b] = shuffled[b * values.size() + k];
  EXPECT_TRUE(back == values);
  return static_cast<double>(stream.size()) / std::max<double>(1, values.size() * sizeof(T));
}

template <class T>
std::vector<T> noise(size_t count) {
  std::mt19937 random(7);
  std::vector<T> result(count);
  for (T& x : result) x = static_cast<T>(random());
  return result;
}

std::vector<float> speeds(size_t count) {
  std::mt19937 random(7);
  std::vector<float> result(count);
  for (float& x : result) x = static_cast<float>(std::normal_distribution(0.0, 0.1)(random));
  return result;
}

TEST(ShuffledDeflate, GivesBackWhatWentIn) {
  for (const size_t count : {0, 1, 2, 100, 4096, 4097, 65536, 200000}) {
    SCOPED_TRACE(count);
    packed_share(noise<uint8_t>(count)), packed_share(noise<uint16_t>(count)), packed_share(noise<uint64_t>(count));
    packed_share(speeds(count));
    std::vector<int64_t> numbers(count);
    std::iota(numbers.begin(), numbers.end(), 0);
    packed_share(numbers);
    packed_share(std::vector<double>(count, 2e-4));
  }
}

TEST(ShuffledDeflate, PacksWhatIsNoNoiseAndAddsNextToNothingToNoise) {
  EXPECT_LT(packed_share(noise<uint32_t>(100000)), 1.001);
  std::vector<float> some_at_rest = speeds(100000);  // two bytes of noise, one of half noise, one of sign and exponent
  EXPECT_LT(packed_share(some_at_rest), 1.001);
  std::fill_n(some_at_rest.begin(), 75000, 0.0F);
  EXPECT_LT(packed_share(some_at_rest), 0.40);
  std::vector<int64_t> numbers(100000);
  std::iota(numbers.begin(), numbers.end(), 0);
  EXPECT_LT(packed_share(numbers), 0.02);
  EXPECT_LT(packed_share(std::vector<float>(100000, 2e-4F)), 0.02);
}

// Levels 1 and 2 of ISA-L do not: where the stack is, which differs from process to process, decides on matches.
TEST(ShuffledDeflate, PacksTheSameNumbersToTheSameBytesWhereverTheStackIs) {
  std::mt19937 random(7);
  std::vector<std::vector<uint32_t>> arrays(100, std::vector<uint32_t>(300));
  for (auto& values : arrays)
    for (uint32_t& x : values) x = 0x00d7230a * (random() % 3);
  const auto packed = [&] {
    std::vector<unsigned char> all;
    for (const auto& values : arrays) {
      const auto* bytes = reinterpret_cast<const unsigned char*>(values.data());
      const auto stream = shuffled_deflate(bytes, values.size(), sizeof(uint32_t));
      all.insert(all.end(), stream.begin(), stream.end());
    }
    return all;
  };
  const auto first = packed();
  const std::function<void(int)> deeper = [&](int levels) {
    std::array<volatile char, 65536> room;
    room.front() = 0;
    EXPECT_TRUE(packed() == first) << levels;
    if (levels > 1) deeper(levels - 1);
  };
  deeper(50);
}

}  // namespace
}  // namespace scree
