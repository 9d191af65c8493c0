// Finds the solid's primitives near the particles of one chunk and lays them out in blocks of sixteen particles.
#pragma once

#include <cstdint>

#include "geometry/solid_index.h"
#include "kernels/cell_grid.h"
#include "kernels/history_table.h"
#include "kernels/particle.h"
#include "kernels/solid_tables.h"

namespace scree {

template <class Real>
struct SolidSearchTask {
  const Particle<Real>* particles;
  uint32_t begin, end, count;
  const CellGrid* grid;
  double skin;  // m
  const SolidIndex* index;
  const std::vector<PreparedPrimitive>* prepared;  // parallel to the imaged solid
  const SolidTables<Real>* tables;
  const uint32_t* old_index;
  const HistoryTable<Real>* history;
  ChunkContacts<Real>* contacts;
  double least_distance;  // of the radius: a centre nearer than this to a surface is reported
};

// Indices of particles, or `count` if there is none.
struct SolidSearchOutcome {
  uint32_t crowded;        // has more than kMaxSlots primitives near it
  uint32_t buried;         // has its centre nearer than least_distance to
  uint32_t buried_in = 0;  // this primitive
};

template <class Real>
SolidSearchOutcome search_solid(const SolidSearchTask<Real>& task);

extern template SolidSearchOutcome search_solid(const SolidSearchTask<float>&);
extern template SolidSearchOutcome search_solid(const SolidSearchTask<double>&);

}  // namespace scree
