// What the contacts of a moment come to for each particle.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "runtime/engine.h"

namespace scree {

// Of the particle with radius R at x:
//   force          F = sum f_c over all its contacts, N, without gravity
//   coordination   particles that touch it
//   wall_contacts  fibres and wall surfaces that touch it
//   stress         s_ab = -1/V sum (x_c - x)_a f_c,b over all its contacts, Pa, V = 4/3 pi R^3, rows a, columns b; x_c
//   is
//                  the contact point. Compression is positive: p = (s_xx + s_yy + s_zz) / 3. A packing of solid
//                  fraction phi bears phi times its mean. It is symmetric where the contacts' torques cancel.
// Source of the stress: Christoffersen, Mehrabadi, Nemat-Nasser, J. Appl. Mech. 48 (1981) 339, for one particle.
struct ContactSums {
  std::vector<Vec3> force;
  std::vector<uint16_t> coordination, wall_contacts;
  std::vector<std::array<double, 9>> stress;
};

// `contacts` are those of Engine::contacts(), `particles` of Engine::particles() at the same moment; so are the
// indices.
ContactSums contact_sums(std::span<const ParticleState> particles, std::span<const ContactState> contacts);

}  // namespace scree
