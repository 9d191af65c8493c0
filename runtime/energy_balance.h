// Whether a run's energy and momentum add up: `energy_ledger = true` in [output] of a case.
//
// Energy, from the run's beginning until now:
//
//   kinetic + removed_kinetic + elastic + damping + friction + rolling
//       = inserted_kinetic + gravity + walls + time_stepping + energy_residual
//
// Each term is summed on its own: what the particles have (kinetic), what contacts hold (elastic), what each force did
// in each step (kernels/contact_work.h). time_stepping is what finite steps make of elastic springs: the elastic
// energy of the overlaps less the work that went into them, and the second order of the kicks. energy_residual is
// round-off, and what a force that is in no term would do. Each force's work is taken with the velocities before the
// kick, so what it does is booked half a step early: time_stepping is of the first order in the step, and what the
// dissipated terms are too much or too little by is in it (some 10 % of what is turned over in the demo's lattice).
// potential is gravity's work told otherwise: what the particles' potential energy, -m g.x, has changed by between
// going in and now or going out. It is -gravity but for a step's way, and there is none where gravity pulls along a
// periodic axis. Momentum likewise:
//
//   momentum + removed_momentum = inserted_momentum + impulse of gravity + impulse of walls and fibres + residual
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "runtime/engine.h"

namespace scree {

// Share of the energy turned over (gravity, insertion, walls) that energy_residual may be, and of the impulses turned
// over that the momentum's may be, when velocities are single-precision numbers: both are round-off of each kick.
inline constexpr double kLedgerTolerance = 1e-3;
// And what time_stepping may be: more, and elastic energy does not go with its forces, or the step is too large.
// Nothing is asked of it where particles are read from a file: what they overlap by is elastic energy that nobody
// booked.
inline constexpr double kTimeSteppingTolerance = 0.2;

struct EnergyBalance {
  double kinetic = 0, inserted_kinetic = 0, removed_kinetic = 0;  // J, all of them
  double gravity = 0, walls = 0, elastic = 0, damping = 0, friction = 0, rolling = 0;
  std::optional<double> potential;
  double time_stepping = 0, energy_residual = 0;
  bool overlaps_unbooked = false;  // particles came from a file
  double turned_over = 0;          // J: |gravity| + |walls| + inserted
  Vec3 momentum{}, inserted_momentum{}, removed_momentum{}, gravity_impulse{}, solid_impulse{};  // N s
  Vec3 momentum_residual{};                                                                      // N s
  double impulse_turned_over = 0;                                                                // N s

  double energy_residual_share() const { return share(energy_residual, turned_over); }
  double momentum_residual_share() const { return share(norm(momentum_residual), impulse_turned_over); }
  double time_stepping_share() const { return share(time_stepping, turned_over); }
  bool closes() const {  // not where a number is none
    return energy_residual_share() <= kLedgerTolerance && momentum_residual_share() <= kLedgerTolerance &&
           (overlaps_unbooked || time_stepping_share() <= kTimeSteppingTolerance);
  }

 private:
  static double share(double part, double whole) { return part == 0 && whole == 0 ? 0 : std::abs(part) / whole; }
};

// Between two steps, of an engine of this case, which asks for a ledger.
EnergyBalance balance_of(const Engine& engine, const Case& c);

// What to warn of; empty where it closes.
std::string complaint(const EnergyBalance& balance);

nlohmann::json to_json(const EnergyBalance& balance);

}  // namespace scree
