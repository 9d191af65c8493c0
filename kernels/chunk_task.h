// What a step needs to know, and what one chunk of it works on.
#pragma once

#include <cstdint>

#include "geometry/closest_point.h"
#include "kernels/contacts.h"
#include "kernels/materials.h"
#include "kernels/particle.h"

namespace scree {

// A primitive of the solid, prepared. In double it is a row of a table that lanes load four doubles at a time.
template <template <class> class Skeleton, class T>
struct alignas(32) Rounded {
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
  bool check_near;       // promote near pairs before the forces
  double inner;          // m: a near pair closer than this becomes active
  double speed_limit;    // m/s: a particle faster than this (or NaN) fails the step
  bool profile = false;  // ChunkOutcome::seconds is wanted
};

// The parts of a chunk's step that a profile tells apart.
enum class StepPart { near_check, pairs, solids, integration };
inline constexpr int kStepParts = 4;

struct ChunkOutcome {
  double max_speed = 0;             // m/s, of the velocities that moved the particles
  double max_pair_overlap = 0;      // share of the sum of the radii
  double max_solid_overlap = 0;     // share of R_i
  bool too_fast = false;            // a speed above the limit, or NaN
  double seconds[kStepParts] = {};  // by StepPart, of the thread that did it; only in a profile
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
  Real* rows;  // scratch: (chunk + 1) rows of eight: force, torque, -, -; the last row collects what is not ours
};

}  // namespace scree
