// The only file that names an instruction set, or the SIMD library (Google Highway, static dispatch: a translation
// unit's compiler flags choose the instruction set, and its types live in a namespace of that set, so several sets link
// into one program).
//
// Why Highway: transposes of 64-byte rows need shuffles, which std::experimental::simd does not have, and exact fused
// multiply-adds and square roots, which xsimd 8 emulates on some targets. Everything used here is IEEE-exact (no
// reciprocal estimates), so every instruction set gives the same bits as the scalar lanes.
//
// A kernel is templated on a lane set L with
//   L::width                     contacts worked on at once
//   L::F, L::D                   `width` floats, `width` doubles (overlaps are formed in D)
//   L::Real                      the storage type of records and histories
// and the free functions below. ScalarLanes<Real> has width 1; ScalarLanes<double> is the double reference.
#pragma once

#define HWY_DISABLE_PCLMUL_AES  // not used here, and not part of x86-64-v3
#include <hwy/highway.h>

#include <cstdint>
#include <type_traits>

#include "geometry/vec.h"

namespace scree {

// ---- one lane
// --------------------------------------------------------------------------------------------------------
template <class RealType>
struct ScalarLanes {
  static constexpr int width = 1;
  using Real = RealType;
  using F = RealType;
  using D = double;

  static F load(const Real* p) { return *p; }
  static void store(F a, Real* p) { *p = a; }
  static D load_doubles(const double* p) { return *p; }
  static D widen(F a) { return static_cast<double>(a); }
  static F narrow(D a) { return static_cast<Real>(a); }
  static unsigned bits(bool mask) { return mask ? 1u : 0u; }
  static bool narrow_mask(bool mask) { return mask; }
  static bool mask_from_bits(unsigned bits) { return bits & 1u; }
  static bool first_lanes(uint32_t count) { return count > 0; }
  // Writes first + lane for each lane of the mask, one behind the other; returns how many. As many words as there are
  // lanes may be overwritten.
  static uint32_t store_lanes(bool mask, uint32_t first, uint32_t* to) {
    *to = first;
    return mask ? 1 : 0;
  }
  static Real max_lane(F a) { return a; }

  // Eight consecutive Reals of each row become eight lane vectors.
  static void load_rows(const Real* const* rows, F (&out)[8]) {
    for (int k = 0; k < 8; ++k) out[k] = rows[0][k];
  }
  // Four consecutive doubles of each row; the fourth may be raw bits.
  static void load_double_rows(const double* const* rows, D (&out)[4]) {
    for (int k = 0; k < 4; ++k) out[k] = rows[0][k];
  }
  // rows[k][0..7] += columns, lane by lane in order (rows may coincide).
  static void add_rows(Real* const* rows, const F (&columns)[8]) {
    for (int k = 0; k < 8; ++k) rows[0][k] += columns[k];
  }
};

// The numbers of a byte's set bits, ascending. (Not inline: the object for AVX-512 shares no symbol with the rest.)
constexpr struct SetBits {
  uint8_t at[256][8];
} kSetBits = [] {
  SetBits t{};
  for (unsigned byte = 0; byte < 256; ++byte)
    for (unsigned bit = 0, n = 0; bit < 8; ++bit)
      if (byte >> bit & 1u) t.at[byte][n++] = static_cast<uint8_t>(bit);
  return t;
}();

// ---- a number of two halves
// --------------------------------------------------------
template <class V>
struct Twice;
template <class V>
Twice<V> make_twice(const V& lo, const V& hi) {
  return {lo, hi};
}

template <class V>
struct Twice {
  V lo, hi;
  Twice() = default;
  Twice(const V& a, const V& b) : lo(a), hi(b) {}
  template <class N>
  requires std::is_arithmetic_v<N>
  explicit Twice(N a) : lo(a), hi(a) {}

  friend Twice operator+(const Twice& a, const Twice& b) { return {a.lo + b.lo, a.hi + b.hi}; }
  friend Twice operator-(const Twice& a, const Twice& b) { return {a.lo - b.lo, a.hi - b.hi}; }
  friend Twice operator*(const Twice& a, const Twice& b) { return {a.lo * b.lo, a.hi * b.hi}; }
  friend Twice operator/(const Twice& a, const Twice& b) { return {a.lo / b.lo, a.hi / b.hi}; }
  friend Twice operator-(const Twice& a) { return {-a.lo, -a.hi}; }
  friend auto operator<(const Twice& a, const Twice& b) { return make_twice(a.lo < b.lo, a.hi < b.hi); }
  friend auto operator>(const Twice& a, const Twice& b) { return make_twice(a.lo > b.lo, a.hi > b.hi); }
  friend auto operator<=(const Twice& a, const Twice& b) { return make_twice(a.lo <= b.lo, a.hi <= b.hi); }
  friend auto operator>=(const Twice& a, const Twice& b) { return make_twice(a.lo >= b.lo, a.hi >= b.hi); }
  friend auto operator==(const Twice& a, const Twice& b) { return make_twice(a.lo == b.lo, a.hi == b.hi); }
  friend Twice operator&(const Twice& a, const Twice& b) { return {a.lo & b.lo, a.hi & b.hi}; }
  friend Twice operator|(const Twice& a, const Twice& b) { return {a.lo | b.lo, a.hi | b.hi}; }
  friend Twice operator!(const Twice& a) { return {!a.lo, !a.hi}; }
  friend bool any(const Twice& a) { return any(a.lo | a.hi); }
  template <class W>
  friend Twice<W> select(const Twice& mask, const Twice<W>& yes, const Twice<W>& no) {
    return {select(mask.lo, yes.lo, no.lo), select(mask.hi, yes.hi, no.hi)};
  }
  friend Twice fma(const Twice& a, const Twice& b, const Twice& c) {
    return {fma(a.lo, b.lo, c.lo), fma(a.hi, b.hi, c.hi)};
  }
  friend Twice sqrt(const Twice& a) { return {sqrt(a.lo), sqrt(a.hi)}; }
  friend Twice abs(const Twice& a) { return {abs(a.lo), abs(a.hi)}; }
  friend Twice round(const Twice& a) { return {round(a.lo), round(a.hi)}; }
  friend Twice min(const Twice& a, const Twice& b) { return {min(a.lo, b.lo), min(a.hi, b.hi)}; }
  friend Twice max(const Twice& a, const Twice& b) { return {max(a.lo, b.lo), max(a.hi, b.hi)}; }
};

// ---- the widest lanes that this translation unit's flags allow
// --------------------------------------------------------
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

struct NativeLanes;

using FloatTag = hn::ScalableTag<float>;
using DoubleTag = hn::ScalableTag<double>;
using FloatVec = hn::Vec<FloatTag>;
using DoubleVec = hn::Vec<DoubleTag>;
inline constexpr int kWidth = static_cast<int>(HWY_LANES(float));
static_assert(kWidth >= 4, "lanes below 128 bits: use ScalarLanes");

struct FMask {
  hn::Mask<FloatTag> m;
};
struct HalfDMask {
  hn::Mask<DoubleTag> m;
};

struct F {
  FloatVec v;
  F() = default;
  F(FloatVec a) : v(a) {}
  template <class N>
  requires std::is_arithmetic_v<N>
  explicit F(N a) : v(hn::Set(FloatTag(), static_cast<float>(a))) {}
};
// Half as many doubles as floats fit a vector: D is two of these.
struct HalfD {
  DoubleVec v;
  HalfD() = default;
  HalfD(DoubleVec a) : v(a) {}
  template <class N>
  requires std::is_arithmetic_v<N>
  explicit HalfD(N a) : v(hn::Set(DoubleTag(), static_cast<double>(a))) {}
};
using D = Twice<HalfD>;
using DMask = Twice<HalfDMask>;

inline F operator+(F a, F b) { return hn::Add(a.v, b.v); }
inline F operator-(F a, F b) { return hn::Sub(a.v, b.v); }
inline F operator*(F a, F b) { return hn::Mul(a.v, b.v); }
inline F operator/(F a, F b) { return hn::Div(a.v, b.v); }
inline F operator-(F a) { return hn::Neg(a.v); }
inline FMask operator<(F a, F b) { return {hn::Lt(a.v, b.v)}; }
inline FMask operator>(F a, F b) { return {hn::Gt(a.v, b.v)}; }
inline FMask operator<=(F a, F b) { return {hn::Le(a.v, b.v)}; }
inline FMask operator>=(F a, F b) { return {hn::Ge(a.v, b.v)}; }
inline FMask operator==(F a, F b) { return {hn::Eq(a.v, b.v)}; }
inline FMask operator&(FMask a, FMask b) { return {hn::And(a.m, b.m)}; }
inline FMask operator|(FMask a, FMask b) { return {hn::Or(a.m, b.m)}; }
inline FMask operator!(FMask a) { return {hn::Not(a.m)}; }
inline bool any(FMask a) { return !hn::AllFalse(FloatTag(), a.m); }
inline F select(FMask m, F yes, F no) { return hn::IfThenElse(m.m, yes.v, no.v); }
inline F fma(F a, F b, F c) { return hn::MulAdd(a.v, b.v, c.v); }
inline F fms(F a, F b, F c) { return hn::MulSub(a.v, b.v, c.v); }
inline F nfma(F a, F b, F c) { return hn::NegMulAdd(a.v, b.v, c.v); }
inline F nfms(F a, F b, F c) { return hn::NegMulSub(a.v, b.v, c.v); }
inline F sqrt(F a) { return hn::Sqrt(a.v); }
inline F abs(F a) { return hn::Abs(a.v); }
inline F min(F a, F b) { return hn::Min(a.v, b.v); }
inline F max(F a, F b) { return hn::Max(a.v, b.v); }

inline HalfD operator+(HalfD a, HalfD b) { return hn::Add(a.v, b.v); }
inline HalfD operator-(HalfD a, HalfD b) { return hn::Sub(a.v, b.v); }
inline HalfD operator*(HalfD a, HalfD b) { return hn::Mul(a.v, b.v); }
inline HalfD operator/(HalfD a, HalfD b) { return hn::Div(a.v, b.v); }
inline HalfD operator-(HalfD a) { return hn::Neg(a.v); }
inline HalfDMask operator<(HalfD a, HalfD b) { return {hn::Lt(a.v, b.v)}; }
inline HalfDMask operator>(HalfD a, HalfD b) { return {hn::Gt(a.v, b.v)}; }
inline HalfDMask operator<=(HalfD a, HalfD b) { return {hn::Le(a.v, b.v)}; }
inline HalfDMask operator>=(HalfD a, HalfD b) { return {hn::Ge(a.v, b.v)}; }
inline HalfDMask operator==(HalfD a, HalfD b) { return {hn::Eq(a.v, b.v)}; }
inline HalfDMask operator&(HalfDMask a, HalfDMask b) { return {hn::And(a.m, b.m)}; }
inline HalfDMask operator|(HalfDMask a, HalfDMask b) { return {hn::Or(a.m, b.m)}; }
inline HalfDMask operator!(HalfDMask a) { return {hn::Not(a.m)}; }
inline HalfD select(HalfDMask m, HalfD yes, HalfD no) { return hn::IfThenElse(m.m, yes.v, no.v); }
inline HalfD fma(HalfD a, HalfD b, HalfD c) { return hn::MulAdd(a.v, b.v, c.v); }
inline HalfD sqrt(HalfD a) { return hn::Sqrt(a.v); }
inline HalfD abs(HalfD a) { return hn::Abs(a.v); }
inline HalfD min(HalfD a, HalfD b) { return hn::Min(a.v, b.v); }
inline HalfD max(HalfD a, HalfD b) { return hn::Max(a.v, b.v); }
inline HalfD round(HalfD a) { return hn::Round(a.v); }

struct NativeLanes {
  static constexpr int width = kWidth;
  using Real = float;
  using F = HWY_NAMESPACE::F;
  using D = HWY_NAMESPACE::D;

  [[gnu::always_inline]] static F load(const float* p) { return hn::LoadU(FloatTag(), p); }
  [[gnu::always_inline]] static void store(F a, float* p) { hn::StoreU(a.v, FloatTag(), p); }
  [[gnu::always_inline]] static D load_doubles(const double* p) {
    return {hn::LoadU(DoubleTag(), p), hn::LoadU(DoubleTag(), p + kWidth / 2)};
  }
  [[gnu::always_inline]] static D widen(F a) {
    const hn::Rebind<float, DoubleTag> half;
    return {hn::PromoteTo(DoubleTag(), hn::LowerHalf(half, a.v)), hn::PromoteTo(DoubleTag(), hn::UpperHalf(half, a.v))};
  }
  [[gnu::always_inline]] static F narrow(D a) {
    const hn::Rebind<float, DoubleTag> half;
    return hn::Combine(FloatTag(), hn::DemoteTo(half, a.hi.v), hn::DemoteTo(half, a.lo.v));
  }
  [[gnu::always_inline]] static unsigned bits(FMask mask) {
    uint8_t bytes[8] = {};
    hn::StoreMaskBits(FloatTag(), mask.m, bytes);
    return static_cast<unsigned>(bytes[0]) | static_cast<unsigned>(bytes[1]) << 8;
  }
  [[gnu::always_inline]] static FMask narrow_mask(DMask mask) { return narrow(select(mask, D(1.0), D(0.0))) > F(0.5f); }
  [[gnu::always_inline]] static FMask mask_from_bits(unsigned bits) {
    const uint8_t bytes[8] = {static_cast<uint8_t>(bits), static_cast<uint8_t>(bits >> 8)};
    return {hn::LoadMaskBits(FloatTag(), bytes)};
  }
  [[gnu::always_inline]] static FMask first_lanes(uint32_t count) { return {hn::FirstN(FloatTag(), count)}; }
  [[gnu::always_inline]] static uint32_t store_lanes(FMask mask, uint32_t first, uint32_t* to) {
    constexpr int group = kWidth < 8 ? kWidth : 8;
    const hn::CappedTag<uint32_t, group> words;
    const hn::Rebind<uint8_t, decltype(words)> bytes;
    uint32_t stored = 0;
    for (int g = 0; g < kWidth; g += group) {
      const unsigned set = bits(mask) >> g & ((1u << group) - 1);
      const auto lanes = hn::PromoteTo(words, hn::LoadU(bytes, kSetBits.at[set]));
      hn::StoreU(hn::Add(lanes, hn::Set(words, first + g)), words, to + stored);
      stored += static_cast<uint32_t>(__builtin_popcount(set));
    }
    return stored;
  }
  [[gnu::always_inline]] static float max_lane(F a) { return hn::GetLane(hn::MaxOfLanes(FloatTag(), a.v)); }

  // A transpose in two steps: 128-bit quarters of four rows into one vector per position, then 4 x 4 inside each.
  [[gnu::always_inline]] static void load_rows(const float* const* rows, F (&out)[8]) {
    transpose_quad(quad(rows, 0, 0), quad(rows, 1, 0), quad(rows, 2, 0), quad(rows, 3, 0), out);
    transpose_quad(quad(rows, 0, 4), quad(rows, 1, 4), quad(rows, 2, 4), quad(rows, 3, 4), out + 4);
  }
  [[gnu::always_inline]] static void load_double_rows(const double* const* rows, D (&out)[4]) {
    constexpr int half = kWidth / 2;
    for (int k = 0; k < 4; k += 2) {
      const DoubleVec a = pair(rows, 0, k), b = pair(rows, 1, k);
      const DoubleVec c = pair(rows + half, 0, k), d = pair(rows + half, 1, k);
      out[k] = {hn::InterleaveLower(DoubleTag(), a, b), hn::InterleaveLower(DoubleTag(), c, d)};
      out[k + 1] = {hn::InterleaveUpper(DoubleTag(), a, b), hn::InterleaveUpper(DoubleTag(), c, d)};
    }
  }
  [[gnu::always_inline]] static void add_rows(float* const* rows, const F (&columns)[8]) {
    F low[4], high[4];
    transpose_quad(columns[0].v, columns[1].v, columns[2].v, columns[3].v, low);
    transpose_quad(columns[4].v, columns[5].v, columns[6].v, columns[7].v, high);
    const hn::Full128<float> d4;
    alignas(64) float a[4][kWidth], b[4][kWidth];
    if constexpr (kWidth == 8) {
      // Row order is part of the result: the same as that of the scalar lanes.
      for (int r = 0; r < 4; ++r)
        add_row(FloatTag(), rows[r], low[r].v, high[r].v,
                [](auto d, auto a, auto b) { return hn::ConcatLowerLower(d, b, a); });
      for (int r = 0; r < 4; ++r)
        add_row(FloatTag(), rows[4 + r], low[r].v, high[r].v,
                [](auto d, auto a, auto b) { return hn::ConcatUpperUpper(d, b, a); });
      return;
    }
    for (int r = 0; r < 4; ++r) {
      hn::Store(low[r].v, FloatTag(), a[r]);
      hn::Store(high[r].v, FloatTag(), b[r]);
    }
    for (int lane = 0; lane < kWidth; ++lane) {
      float* row = rows[lane];
      const int from = lane / 4 * 4;
      hn::StoreU(hn::Add(hn::LoadU(d4, row), hn::Load(d4, a[lane % 4] + from)), d4, row);
      hn::StoreU(hn::Add(hn::LoadU(d4, row + 4), hn::Load(d4, b[lane % 4] + from)), d4, row + 4);
    }
  }

 private:
  template <class Tag>
  [[gnu::always_inline]] static void add_row(Tag d, float* row, hn::Vec<Tag> a, hn::Vec<Tag> b, const auto& join) {
    hn::StoreU(hn::Add(hn::LoadU(d, row), join(d, a, b)), d, row);
  }
  // Words offset..offset+3 of rows r, r+4, r+8, ...
  [[gnu::always_inline]] static FloatVec quad(const float* const* rows, int r, int offset) {
    return quarters(FloatTag(), hn::Full128<float>(), rows + r, 4, offset);
  }
  // Doubles offset, offset+1 of rows r, r+2, r+4, ...
  [[gnu::always_inline]] static DoubleVec pair(const double* const* rows, int r, int offset) {
    return quarters(DoubleTag(), hn::Full128<double>(), rows + r, 2, offset);
  }
  // A vector of the 128 bits at `offset` in rows 0, stride, 2 stride, ...
  template <class Tag, class Tag128, class T>
  [[gnu::always_inline]] static hn::Vec<Tag> quarters(Tag d, Tag128 d128, const T* const* rows, int stride,
                                                      int offset) {
    constexpr int count = static_cast<int>(HWY_LANES(T) / (16 / sizeof(T)));
    const auto at = [&](int k) { return hn::LoadU(d128, rows[k * stride] + offset); };
    if constexpr (count == 1) {
      return at(0);
    } else if constexpr (count == 2) {
      return hn::Combine(d, at(1), at(0));
    } else {
      const hn::Half<Tag> half;
      return hn::Combine(d, hn::Combine(half, at(3), at(2)), hn::Combine(half, at(1), at(0)));
    }
  }
  [[gnu::always_inline]] static void transpose_quad(FloatVec a, FloatVec b, FloatVec c, FloatVec e, F* out) {
    const FloatTag d;
    const DoubleTag dd;
    const auto ab_low = hn::BitCast(dd, hn::InterleaveLower(d, a, b)),
               ab_high = hn::BitCast(dd, hn::InterleaveUpper(d, a, b));
    const auto ce_low = hn::BitCast(dd, hn::InterleaveLower(d, c, e)),
               ce_high = hn::BitCast(dd, hn::InterleaveUpper(d, c, e));
    out[0] = hn::BitCast(d, hn::InterleaveLower(dd, ab_low, ce_low));
    out[1] = hn::BitCast(d, hn::InterleaveUpper(dd, ab_low, ce_low));
    out[2] = hn::BitCast(d, hn::InterleaveLower(dd, ab_high, ce_high));
    out[3] = hn::BitCast(d, hn::InterleaveUpper(dd, ab_high, ce_high));
  }
};

}  // namespace HWY_NAMESPACE

// ---- the sets of instructions: every machine of the build's architecture has the native one, some have the wide one
// --------------------------------------------------------------------------------------------------------
#if defined(__x86_64__)
inline constexpr const char *kNativeSet = "avx2", *kWideSet = "avx512";
#elif defined(__aarch64__)
inline constexpr const char *kNativeSet = "neon", *kWideSet = nullptr;
#else
inline constexpr const char *kNativeSet = "native", *kWideSet = nullptr;
#endif
inline constexpr const char* kScalarSet = "scalar";

#if defined(__x86_64__)
static inline bool machine_has_wide_set() {  // x86-64-v4
  __builtin_cpu_init();
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
         __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
}
#endif

}  // namespace scree
