// What a step needs to know, and what one chunk of it works on.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "geometry/closest_point.h"
#include "kernels/contacts.h"
#include "kernels/materials.h"
#include "kernels/particle.h"
#include "kernels/step_outcome.h"

namespace scree {

// A primitive of the solid, prepared. In double it is a row of a table that lanes load four doubles at a time.
template <template <class> class Skeleton, class T>
struct alignas(std::max<size_t>(32, alignof(Skeleton<T>))) Rounded {
  Skeleton<T> skeleton;
  T radius;
};

template <class Real>
struct SolidSurface {  // parallel to the rows
  Vec<Real> velocity;  // m/s
  uint32_t column;     // in the material table
};

// One kind of skeleton. The last row is a dummy far away, for padding lanes.
template <template <class> class Skeleton, class Real>
struct SkeletonTable {
  const Rounded<Skeleton, double>* rows;
  const SolidSurface<Real>* surface;
};

struct StepSettings {
  double dt;                            // s
  double kick;                          // s, time that velocities advance: dt, or dt/2 in a run's first step
  double history_dt;                    // s, time that histories advance: dt, or 0 in a run's first step
  double gravity[3];                    // m/s2
  double period[3], inverse_period[3];  // m, 1/m; 0: not periodic
  bool limit_attraction;
  double speed_limit;    // m/s: a particle faster than this (or NaN) fails the step
  bool profile = false;  // ChunkOutcome::seconds is wanted
};

template <class Real>
struct ChunkTask {
  const Particle<Real>* old_particles;  // the whole domain, with two dummies at `count`
  Particle<Real>* new_particles;
  uint32_t begin, end;  // the chunk
  uint32_t count;       // particles in the domain
  ChunkContacts<Real>* contacts;
  const MaterialTable<Real>* materials;
  SkeletonTable<SegmentOf, Real> segments;
  SkeletonTable<QuadOf, Real> quads;
  SkeletonTable<RevolutionOf, Real> revolutions;
  const StepSettings* settings;
  Look look;   // at waiting pairs, before the forces
  Real* rows;  // scratch: (chunk + 1) rows of eight: force, torque, -, -; the last row collects what is not ours
};

}  // namespace scree
