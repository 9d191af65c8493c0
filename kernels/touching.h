// The contacts that touch now, with their forces, one by one or summed: for averages, pictures and checks, not for the
// step.
//
// Evaluated by the laws and passes of the step, on the records as they are (positions of now, velocities half a step
// behind): the forces are those that the next step will apply. Nothing is written.
#pragma once

#include <functional>

#include "kernels/chunk_task.h"

namespace scree {

struct TouchingContact {
  uint32_t i = 0;             // particle
  uint32_t j = 0;             // particle, or row in the table of the primitive's skeleton kind
  int skeleton = -1;          // -1: j is a particle; 0 segment, 1 quad, 2 revolution
  double overlap = 0;         // m, > 0
  Vec<double> normal{};       // unit, from j to i
  Vec<double> point{};        // m: on the surface of j where that is solid, midway in the overlap between particles
  Vec<double> force{};        // N, on i
  Vec<double> slip{};         // m/s, tangential velocity of i relative to j at the contact
  double elastic_energy = 0;  // J, of the normal spring: 2/5 of its force times the overlap (Hertz)
};

using VisitTouching = std::function<void(const TouchingContact&)>;

// Visit the contacts in the task's lists (a pair across two chunks is in both). task.new_particles, task.rows and
// task.contacts are not used.
template <class Real>
void visit_touching_pairs(const ChunkTask<Real>& task, const ChunkContacts<Real>& contacts, const VisitTouching& visit);
template <class Real>
void visit_touching_solids(const ChunkTask<Real>& task, const ChunkContacts<Real>& contacts,
                           const VisitTouching& visit);

// What the contacts in the task's lists come to for each of its particles, added to `rows`: (chunk + 1) rows of
// kSumRow, of which the last collects what is another chunk's:
//   0..2    force, N
//   3..8    xx, yy, zz, xy, yz, xz of the sum over contacts of arm sym(n (x) f), N m: n unit, from the contact's point
//           to the particle's centre, arm their distance, f the force
//   9, 10   contacts with particles, with solids
// The order of additions, and so the bits, are those of every lane width.
inline constexpr size_t kSumRow = 16;
template <class Real>
void sum_touching(const ChunkTask<Real>& task, const ChunkContacts<Real>& contacts, Real* rows);

extern template void visit_touching_pairs(const ChunkTask<float>&, const ChunkContacts<float>&, const VisitTouching&);
extern template void visit_touching_pairs(const ChunkTask<double>&, const ChunkContacts<double>&, const VisitTouching&);
extern template void visit_touching_solids(const ChunkTask<float>&, const ChunkContacts<float>&, const VisitTouching&);
extern template void visit_touching_solids(const ChunkTask<double>&, const ChunkContacts<double>&,
                                           const VisitTouching&);
extern template void sum_touching(const ChunkTask<float>&, const ChunkContacts<float>&, float*);
extern template void sum_touching(const ChunkTask<double>&, const ChunkContacts<double>&, double*);

}  // namespace scree
