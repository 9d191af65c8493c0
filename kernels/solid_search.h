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
};

// Returns the index of a particle with more than kMaxSlots primitives near it, or `count` if there is none.
template <class Real>
uint32_t search_solid(const SolidSearchTask<Real>& task);

extern template uint32_t search_solid(const SolidSearchTask<float>&);
extern template uint32_t search_solid(const SolidSearchTask<double>&);

}  // namespace scree
