// The few operations that code templated on a number type T may use beyond + - * / and comparisons, for the scalars.
// A SIMD type brings its own in its own namespace, found by argument-dependent lookup:
//   min(a, b)   max(a, b)   abs(a)   sqrt(a)   fma(a, b, c) = a b + c rounded once   select(mask, a, b) = mask ? a : b
//   fms = a b - c   nfma = c - a b   nfms = -a b - c, rounded once; from fma, unless the type has them as one
//   instruction round(a) to nearest, ties to even   any(mask): true in some lane
// A comparison of two T gives a mask (bool here); masks combine with & and |, never && and ||, and are held in `auto`.
#pragma once

#include <cmath>

namespace scree {

// Both operands are values already, so min, max and select compile to one instruction without a branch.
inline double min(double a, double b) { return a < b ? a : b; }
inline double max(double a, double b) { return a > b ? a : b; }
inline double abs(double a) { return std::fabs(a); }
inline double sqrt(double a) { return std::sqrt(a); }
inline double fma(double a, double b, double c) { return std::fma(a, b, c); }
inline double select(bool mask, double a, double b) { return mask ? a : b; }

inline double round(double a) { return std::nearbyint(a); }
inline bool any(bool mask) { return mask; }

inline float min(float a, float b) { return a < b ? a : b; }
inline float max(float a, float b) { return a > b ? a : b; }
inline float abs(float a) { return std::fabs(a); }
inline float sqrt(float a) { return std::sqrt(a); }
inline float fma(float a, float b, float c) { return std::fma(a, b, c); }
inline float select(bool mask, float a, float b) { return mask ? a : b; }

template <class T>
inline T fms(const T& a, const T& b, const T& c) {
  return fma(a, b, -c);
}
template <class T>
inline T nfma(const T& a, const T& b, const T& c) {
  return fma(-a, b, c);
}
template <class T>
inline T nfms(const T& a, const T& b, const T& c) {
  return fma(-a, b, -c);
}

}  // namespace scree
