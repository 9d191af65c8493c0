// What the contacts of a moment come to for each particle.
#pragma once

#include <array>
#include <cstdint>

#include "kernels/array.h"
#include "runtime/engine.h"

namespace scree {

// Of the particle with radius R at x:
//   force          F = sum f_c over all its contacts, N, without gravity
//   coordination   particles that touch it
//   wall_contacts  fibres and wall surfaces that touch it
//   stress         s = -1/V sum sym((x_c - x) (x) f_c) over all its contacts, Pa; V = 4/3 pi R^3, x_c the contact's
//                  point, sym(A) = (A + A^T) / 2, which leaves out the contacts' torque. Compression is positive:
//                  p = (s_xx + s_yy + s_zz) / 3. A packing of solid fraction phi bears phi times its mean.
// Source of the stress: Christoffersen, Mehrabadi, Nemat-Nasser, J. Appl. Mech. 48 (1981) 339, for one particle.
struct ContactSum {
  Vec3 force{0, 0, 0};
  std::array<float, 6> stress{};  // xx, yy, zz, xy, yz, xz
  uint16_t coordination = 0, wall_contacts = 0;
};

// In the order of Engine::particles(). Empty while the engine does not know its contacts.
Array<ContactSum> contact_sums(const Engine& engine);

}  // namespace scree
