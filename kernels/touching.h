// The contacts that touch now, one by one, with their forces: for averages, pictures and checks, not for the step.
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

extern template void visit_touching_pairs(const ChunkTask<float>&, const ChunkContacts<float>&, const VisitTouching&);
extern template void visit_touching_pairs(const ChunkTask<double>&, const ChunkContacts<double>&, const VisitTouching&);
extern template void visit_touching_solids(const ChunkTask<float>&, const ChunkContacts<float>&, const VisitTouching&);
extern template void visit_touching_solids(const ChunkTask<double>&, const ChunkContacts<double>&,
                                           const VisitTouching&);

}  // namespace scree
