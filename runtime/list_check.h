// Proves that the contact lists hold every contact, by a fresh search of its own: what a missed rebuild, a wrong bound
// on the particles' travel or a wrong search would break first. Reads only. Few particles are looked through by brute
// force, every pair and every primitive, with none of the engine's search in it; for many, a grid of cells and the
// solid's index are asked anew, which costs about as much as a list rebuild.
#pragma once

#include <optional>
#include <vector>

#include "geometry/closest_point.h"
#include "geometry/solid_index.h"
#include "kernels/contacts.h"
#include "kernels/particle.h"
#include "kernels/solid_tables.h"

namespace scree {

inline constexpr uint32_t kBruteForceUpTo = 20000;          // particles: 0.4 G pairs, a second of a core
inline constexpr uint64_t kMostLooksAtSolid = 400'000'000;  // particles times primitives, likewise

// The particles as they were when the step took its forces, and the lists that it took them from.
template <class Real>
struct ListCheckTask {
  const Particle<Real>* particles;
  uint32_t count, chunk_size;
  const std::vector<ChunkContacts<Real>>* contacts;  // by chunk
  Bounds box;
  const double *period, *inverse_period;  // m, 1/m; 0: not periodic
  double max_radius;                      // m
  const SolidIndex* index;
  const SolidTables<Real>* tables;
  const std::vector<PreparedPrimitive>* prepared;  // what `index` finds, for brute force
  uint32_t brute_force_up_to = kBruteForceUpTo;    // particles
};

struct MissingContact {
  uint32_t i = 0;             // the particle
  std::optional<uint32_t> j;  // the other one; without it the contact is with the solid
  int kind = 0;               // of the solid's skeleton, and
  uint32_t row = 0;           // its row in that kind's table
  double overlap = 0;         // m
};

// The missing contact of the lowest particle index, or nothing.
template <class Real>
std::optional<MissingContact> find_missing_contact(const ListCheckTask<Real>& task);

extern template std::optional<MissingContact> find_missing_contact(const ListCheckTask<float>&);
extern template std::optional<MissingContact> find_missing_contact(const ListCheckTask<double>&);

}  // namespace scree
