// The particle record: one cache line in the mixed-precision engine, so that a neighbour costs one line.
#pragma once

#include <cstdint>

namespace scree {

// Real = float: the production record, 64 B. Real = double: the reference, 96 B.
// position m, velocity m/s and spin rad/s half a step behind the position (leapfrog), radius m, inverse mass 1/kg.
// The two halves (position and tag; the eight Reals) are read by the SIMD kernels as rows: keep their order.
template <class Real>
struct alignas(32) Particle {
  double x, y, z;
  uint64_t tag;  // kind in the top 8 bits, global id below
  Real vx, vy, vz;
  Real wx, wy, wz;
  Real radius, inverse_mass;

  uint32_t kind() const { return static_cast<uint32_t>(tag >> 56); }
  uint64_t id() const { return tag & 0x00ffffffffffffffull; }
  static uint64_t make_tag(uint32_t kind, uint64_t id) { return (static_cast<uint64_t>(kind) << 56) | id; }
};
static_assert(sizeof(Particle<float>) == 64);
static_assert(sizeof(Particle<double>) == 96);

inline constexpr uint32_t kMaxKinds = 255;

}  // namespace scree
