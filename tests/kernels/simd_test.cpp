// The lanes against what they stand for: one number after the other.
#include "kernels/simd.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <random>

namespace scree {
namespace {

using Native = HWY_NAMESPACE::NativeLanes;
constexpr int kMost = 16;

class Random {
 public:
  double between(double low, double high) { return low + (high - low) * (engine_() / 4294967296.0); }
  float single() { return static_cast<float>(between(-10, 10) * std::pow(10, between(-5, 5))); }
  uint32_t below(uint32_t n) { return static_cast<uint32_t>(engine_() % n); }

 private:
  std::mt19937 engine_{42};
};

void store_doubles(const ScalarLanes<float>::D& a, double* p) { *p = a; }
void store_doubles(const Native::D& a, double* p) { std::memcpy(p, &a, sizeof a); }

template <class L>
class Lanes : public ::testing::Test {
 protected:
  using Real = typename L::Real;
  using F = typename L::F;
  using D = typename L::D;
  static constexpr int width = L::width;
  Random random;

  std::vector<Real> numbers(size_t n) {
    std::vector<Real> result(n);
    for (Real& x : result) x = static_cast<Real>(random.single());
    return result;
  }
  static std::vector<Real> stored(const F& a) {
    std::vector<Real> result(width);
    L::store(a, result.data());
    return result;
  }
  static std::vector<double> stored_doubles(const D& a) {
    std::vector<double> result(width);
    store_doubles(a, result.data());
    return result;
  }
};
using AllLanes = ::testing::Types<ScalarLanes<float>, ScalarLanes<double>, Native>;
TYPED_TEST_SUITE(Lanes, AllLanes);

TYPED_TEST(Lanes, LoadAndStoreAreInverse) {
  const auto x = this->numbers(kMost + 3);
  for (size_t from = 0; from < 3; ++from)
    EXPECT_EQ(this->stored(TypeParam::load(&x[from])),
              std::vector(x.begin() + from, x.begin() + from + TypeParam::width));
}

TYPED_TEST(Lanes, RowsBecomeColumns) {
  constexpr int width = TypeParam::width;
  using Real = typename TypeParam::Real;
  for (int trial = 0; trial < 50; ++trial) {
    const auto table = this->numbers(8 * 40);
    const Real* rows[width];
    for (int k = 0; k < width; ++k) rows[k] = &table[8 * this->random.below(40)];
    typename TypeParam::F columns[8];
    TypeParam::load_rows(rows, columns);
    for (int c = 0; c < 8; ++c) {
      const auto column = this->stored(columns[c]);
      for (int k = 0; k < width; ++k) ASSERT_EQ(column[k], rows[k][c]) << "column " << c << ", lane " << k;
    }
  }
}

// The fourth double of a record is its tag, any bits at all.
TYPED_TEST(Lanes, DoubleRowsBecomeColumnsBitForBit) {
  constexpr int width = TypeParam::width;
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<double> table(4 * 40);
    for (double& x : table)
      x = std::bit_cast<double>(uint64_t{this->random.below(0xffffffffu)} << 24 | this->random.below(1u << 24));
    const double* rows[width];
    for (int k = 0; k < width; ++k) rows[k] = &table[4 * this->random.below(40)];
    typename TypeParam::D columns[4];
    TypeParam::load_double_rows(rows, columns);
    for (int c = 0; c < 4; ++c) {
      const auto column = this->stored_doubles(columns[c]);
      for (int k = 0; k < width; ++k)
        ASSERT_EQ(std::bit_cast<uint64_t>(column[k]), std::bit_cast<uint64_t>(rows[k][c]));
    }
  }
}

// Coinciding rows take every lane's share, in the order of the lanes: the order decides the last bits.
TYPED_TEST(Lanes, RowsAreAddedToInLaneOrderEvenWhereTheyCoincide) {
  constexpr int width = TypeParam::width;
  using Real = typename TypeParam::Real;
  for (const uint32_t distinct : {1, 2, 3, 7, 40})
    for (int trial = 0; trial < 50; ++trial) {
      auto table = this->numbers(8 * distinct), expected = table;
      const auto values = this->numbers(8 * width);
      typename TypeParam::F columns[8];
      for (int c = 0; c < 8; ++c) columns[c] = TypeParam::load(&values[c * width]);
      Real* rows[width];
      for (int k = 0; k < width; ++k) {
        const uint32_t row = this->random.below(distinct);
        rows[k] = &table[8 * row];
        for (int c = 0; c < 8; ++c) expected[8 * row + c] += values[c * width + k];
      }
      TypeParam::add_rows(rows, columns);
      ASSERT_EQ(table, expected) << distinct << " rows";
    }
}

TYPED_TEST(Lanes, WideningIsExactAndNarrowingRoundsToNearest) {
  constexpr int width = TypeParam::width;
  using Real = typename TypeParam::Real;
  for (int trial = 0; trial < 100; ++trial) {
    const auto x = this->numbers(width);
    const auto wide = this->stored_doubles(TypeParam::widen(TypeParam::load(x.data())));
    for (int k = 0; k < width; ++k) ASSERT_EQ(wide[k], static_cast<double>(x[k]));
    std::vector<double> y(width);
    for (double& v : y) v = this->random.between(-1, 1) * 1e3;
    const auto narrow = this->stored(TypeParam::narrow(TypeParam::load_doubles(y.data())));
    for (int k = 0; k < width; ++k) ASSERT_EQ(narrow[k], static_cast<Real>(y[k]));
    EXPECT_EQ(this->stored(TypeParam::narrow(TypeParam::widen(TypeParam::load(x.data())))), x);
  }
}

TYPED_TEST(Lanes, NumbersOfAMasksLanesAreStoredOneBehindTheOther) {
  constexpr uint32_t width = TypeParam::width;
  for (unsigned wanted = 0; wanted < (1u << width); wanted += 1 + wanted / 999) {
    std::vector<uint32_t> expected, stored(2 * width, 7);
    for (uint32_t lane = 0; lane < width; ++lane)
      if (wanted >> lane & 1u) expected.push_back(4000000000u + lane);
    const uint32_t count = TypeParam::store_lanes(TypeParam::mask_from_bits(wanted), 4000000000u, stored.data());
    ASSERT_EQ(std::vector(stored.begin(), stored.begin() + count), expected);
    EXPECT_EQ(std::count(stored.begin() + width, stored.end(), 7u), width) << "written beyond a vector";
  }
}

TYPED_TEST(Lanes, TheFirstLanesAreAsManyAsThereAre) {
  for (uint32_t count = 0; count < 40; ++count)
    EXPECT_EQ(TypeParam::bits(TypeParam::first_lanes(count)), (1u << std::min<uint32_t>(count, TypeParam::width)) - 1);
}

TYPED_TEST(Lanes, BitsAndMasksAreInverse) {
  constexpr int width = TypeParam::width;
  using F = typename TypeParam::F;
  for (unsigned wanted = 0; wanted < (1u << width); wanted += 1 + wanted / 99) {
    EXPECT_EQ(TypeParam::bits(TypeParam::mask_from_bits(wanted)), wanted);
    EXPECT_EQ(any(TypeParam::mask_from_bits(wanted)), wanted != 0);
    // Bits above the lanes belong to other lanes of the block.
    EXPECT_EQ(TypeParam::bits(TypeParam::mask_from_bits(wanted | 0xffffu << width)), wanted);
    const auto chosen = this->stored(select(TypeParam::mask_from_bits(wanted), F(1), F(2)));
    for (int k = 0; k < width; ++k) EXPECT_EQ(chosen[k], wanted >> k & 1u ? 1 : 2);
  }
}

TYPED_TEST(Lanes, MasksOfDoublesNarrow) {
  constexpr int width = TypeParam::width;
  using D = typename TypeParam::D;
  for (int trial = 0; trial < 100; ++trial) {
    std::vector<double> x(width);
    unsigned expected = 0;
    for (int k = 0; k < width; ++k) x[k] = this->random.between(-1, 1), expected |= (x[k] > 0.25 ? 1u : 0u) << k;
    EXPECT_EQ(TypeParam::bits(TypeParam::narrow_mask(TypeParam::load_doubles(x.data()) > D(0.25))), expected);
  }
}

TYPED_TEST(Lanes, MaxLaneIsTheLargest) {
  for (int trial = 0; trial < 50; ++trial) {
    const auto x = this->numbers(TypeParam::width);
    EXPECT_EQ(TypeParam::max_lane(TypeParam::load(x.data())), *std::max_element(x.begin(), x.end()));
  }
}

// Every operation the laws use, rounded as the scalar one is.
TEST(NativeLanes, ComputeWithTheScalarBits) {
  Random random;
  constexpr int width = Native::width;
  using F = Native::F;
  const auto expect_same = [](const F& lanes, const std::array<float, width>& scalar) {
    std::array<float, width> got;
    Native::store(lanes, got.data());
    for (int k = 0; k < width; ++k) EXPECT_EQ(std::bit_cast<uint32_t>(got[k]), std::bit_cast<uint32_t>(scalar[k]));
  };
  for (int trial = 0; trial < 200; ++trial) {
    std::array<float, width> a, b, c, r;
    for (int k = 0; k < width; ++k) a[k] = random.single(), b[k] = random.single(), c[k] = random.single();
    const F fa = Native::load(a.data()), fb = Native::load(b.data()), fc = Native::load(c.data());
    const auto each = [&](const auto& f) {
      for (int k = 0; k < width; ++k) r[k] = f(a[k], b[k], c[k]);
      return r;
    };
    expect_same(fa + fb, each([](float x, float y, float) { return x + y; }));
    expect_same(fa - fb, each([](float x, float y, float) { return x - y; }));
    expect_same(fa * fb, each([](float x, float y, float) { return x * y; }));
    expect_same(fa / fb, each([](float x, float y, float) { return x / y; }));
    expect_same(-fa, each([](float x, float, float) { return -x; }));
    expect_same(sqrt(abs(fa)), each([](float x, float, float) { return std::sqrt(std::fabs(x)); }));
    expect_same(fma(fa, fb, fc), each([](float x, float y, float z) { return std::fma(x, y, z); }));
    expect_same(min(fa, fb), each([](float x, float y, float) { return std::min(x, y); }));
    expect_same(max(fa, fb), each([](float x, float y, float) { return std::max(x, y); }));
    expect_same(select(fa < fb, fa, fc), each([](float x, float y, float z) { return x < y ? x : z; }));
    expect_same(select(fa >= fb, fa, fc), each([](float x, float y, float z) { return x >= y ? x : z; }));
    expect_same(select((fa > fb) & !(fa > fc), fa, fb),
                each([](float x, float y, float z) { return x > y && !(x > z) ? x : y; }));
  }
}

TEST(NativeLanes, TreatNumbersThatAreNoneAsScalarsDo) {
  const float nan = std::nanf("");
  using F = Native::F;
  EXPECT_FALSE(any(F(nan) <= F(1)));
  EXPECT_FALSE(any(F(nan) > F(1)));
  EXPECT_EQ(Native::bits(!(F(nan) > F(1))), (1u << Native::width) - 1);
  EXPECT_EQ(Native::max_lane(select(F(nan) > F(0), F(nan), F(3))), 3);
}

TEST(NativeLanes, RoundDoublesToNearestTiesToEven) {
  std::vector<double> x(Native::width), got(Native::width);
  for (const double first : {0.5, -1.25, 2.5, -3.7, 1e9 + 0.5}) {
    for (int k = 0; k < Native::width; ++k) x[k] = first + k;
    store_doubles(round(Native::load_doubles(x.data())), got.data());
    for (int k = 0; k < Native::width; ++k) EXPECT_EQ(got[k], std::nearbyint(x[k]));
  }
}

}  // namespace
}  // namespace scree
