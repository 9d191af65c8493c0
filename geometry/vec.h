// A three-vector over any number type: double for set-up, float and SIMD lanes in the kernels.
// Only what the laws and the closest-point functions need; set-up algebra beyond this uses Eigen.
#pragma once

#include <Eigen/Core>

#include "geometry/number.h"

namespace scree {

template <class T>
struct Vec {
  T x, y, z;
};

using Vec3 = Vec<double>;

template <class T>
inline Vec<T> operator+(const Vec<T>& a, const Vec<T>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class T>
inline Vec<T> operator-(const Vec<T>& a, const Vec<T>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T>
inline Vec<T> operator-(const Vec<T>& a) {
  return {-a.x, -a.y, -a.z};
}
template <class T>
inline Vec<T> operator*(const T& s, const Vec<T>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <class T>
inline Vec<T> operator*(const Vec<T>& a, const T& s) {
  return s * a;
}
template <class T>
inline Vec<T>& operator+=(Vec<T>& a, const Vec<T>& b) {
  return a = a + b;
}
template <class T>
inline Vec<T>& operator-=(Vec<T>& a, const Vec<T>& b) {
  return a = a - b;
}
// Fused where it is written so, and nowhere else: the bits do not depend on the compiler. Both change sign exactly when
// one factor does, which the two copies of a pair's contact rely on (kernels/contacts.h).
template <class T>
inline T dot(const Vec<T>& a, const Vec<T>& b) {
  return fma(a.z, b.z, fma(a.y, b.y, a.x * b.x));
}
template <class T>
inline Vec<T> cross(const Vec<T>& a, const Vec<T>& b) {
  return {fms(a.y, b.z, a.z * b.y), fms(a.z, b.x, a.x * b.z), fms(a.x, b.y, a.y * b.x)};
}
// s a + b
template <class T>
inline Vec<T> fma(const T& s, const Vec<T>& a, const Vec<T>& b) {
  return {fma(s, a.x, b.x), fma(s, a.y, b.y), fma(s, a.z, b.z)};
}
// b - s a, and -s a - b
template <class T>
inline Vec<T> nfma(const T& s, const Vec<T>& a, const Vec<T>& b) {
  return {nfma(s, a.x, b.x), nfma(s, a.y, b.y), nfma(s, a.z, b.z)};
}
template <class T>
inline Vec<T> nfms(const T& s, const Vec<T>& a, const Vec<T>& b) {
  return {nfms(s, a.x, b.x), nfms(s, a.y, b.y), nfms(s, a.z, b.z)};
}
template <class T>
inline Vec<T> select_vec(const auto& mask, const Vec<T>& yes, const Vec<T>& no) {
  return {select(mask, yes.x, no.x), select(mask, yes.y, no.y), select(mask, yes.z, no.z)};
}
inline double norm(const Vec3& a) { return std::sqrt(dot(a, a)); }
inline Vec3 unit(const Vec3& a) { return (1.0 / norm(a)) * a; }

// A fixed unit vector perpendicular to the unit vector `axis`: the coordinate axis furthest from it, made
// perpendicular.
inline Vec3 perpendicular_to(const Vec3& axis) {
  const double x = std::abs(axis.x), y = std::abs(axis.y), z = std::abs(axis.z);
  const Vec3 start = x <= y && x <= z ? Vec3{1, 0, 0} : y <= z ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
  return unit(start - dot(start, axis) * axis);
}

inline Eigen::Vector3d to_eigen(const Vec3& a) { return {a.x, a.y, a.z}; }
inline Vec3 from_eigen(const Eigen::Vector3d& a) { return {a.x(), a.y(), a.z()}; }

}  // namespace scree
