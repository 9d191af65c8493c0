// What follows from a case by formula: time scales, the time step, the material table, sizes.
#pragma once

#include "kernels/materials.h"
#include "runtime/case.h"

namespace scree {

// pi R sqrt(rho/G) / (0.1631 nu + 0.8766), G = E / (2 (1 + nu)); s.
double rayleigh_time(const Material& m, double radius);

// 2.87 (m^2 / (R' E*^2 v))^(1/5), m the particle's mass, R' = R/2, E* of two such particles; s. v in m/s.
double hertz_time(const Material& m, double radius, double speed);

double smallest_radius(const Case& c);  // m, over all kinds' distributions; a file's radii are not known here
double largest_radius(const Case& c);
double smallest_rayleigh_time(const Case& c);

// time.step, or rayleigh_fraction of the smallest Rayleigh time.
double time_step_of(const Case& c);

double sphere_mass(double radius, double density);

// Rows for every pair of kinds and every kind with every wall material that occurs. Pairs the case does not list stay
// zero; the reader has checked that those that can meet are there.
template <class Real>
MaterialTable<Real> material_table(const Case& c);

}  // namespace scree
