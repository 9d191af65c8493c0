// How big a case is, from its description alone. Time scales: runtime/case_physics.h.
#pragma once

#include "runtime/case.h"

namespace scree {

double smallest_diameter(const SizeDistribution& size);  // m
double largest_diameter(const SizeDistribution& size);   // m

// Mean volume of one particle, m3, over the number distribution (truncated normal and lognormal are number
// distributions; a list gives mass or number fractions).
double mean_particle_volume(const SizeDistribution& size);

// How much of a normal or lognormal distribution its limits leave, 0..1. Diameters are drawn until one lies between.
double share_between_limits(const SizeDistribution& size);

double volume_of(const Region& region);  // m3
Bounds bounds_of(const Region& region);  // tight

// Particles of a mixture per kg.
double particles_per_mass(const Case& c, const Mixture& mixture);

// Particles that a stage brings in: exact for counts and files, the expectation for masses and "as many as fit".
double expected_particles(const Case& c, const StageAction& action);
double expected_particles(const Case& c);  // all stages

// Physical time at most, s, from the stages' longest times and pours; a drain without max_time counts nothing.
double longest_time(const Case& c);

}  // namespace scree
