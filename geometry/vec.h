// A three-vector over any number type: double for set-up, float and SIMD lanes in the kernels.
// Only what the laws and the closest-point functions need; set-up algebra beyond this uses Eigen.
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace scree {

template <class T>
struct Vec {
  T x, y, z;
};

using Vec3 = Vec<double>;

template <class T> inline Vec<T> operator+(const Vec<T>& a, const Vec<T>& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
template <class T> inline Vec<T> operator-(const Vec<T>& a, const Vec<T>& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
template <class T> inline Vec<T> operator-(const Vec<T>& a) { return {-a.x, -a.y, -a.z}; }
template <class T> inline Vec<T> operator*(const T& s, const Vec<T>& a) { return {s * a.x, s * a.y, s * a.z}; }
template <class T> inline Vec<T> operator*(const Vec<T>& a, const T& s) { return s * a; }
template <class T> inline Vec<T>& operator+=(Vec<T>& a, const Vec<T>& b) { return a = a + b; }
template <class T> inline Vec<T>& operator-=(Vec<T>& a, const Vec<T>& b) { return a = a - b; }
template <class T> inline T dot(const Vec<T>& a, const Vec<T>& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
template <class T> inline Vec<T> cross(const Vec<T>& a, const Vec<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double norm(const Vec3& a) { return std::sqrt(dot(a, a)); }
inline Vec3 unit(const Vec3& a) { return (1.0 / norm(a)) * a; }

inline Eigen::Vector3d to_eigen(const Vec3& a) { return {a.x, a.y, a.z}; }
inline Vec3 from_eigen(const Eigen::Vector3d& a) { return {a.x(), a.y(), a.z()}; }

}  // namespace scree
