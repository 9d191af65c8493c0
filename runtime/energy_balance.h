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
// round-off, and what a force that is in no term would do. potential is gravity's work told otherwise: what the
// particles' potential energy, -m g.x, has changed by between going in and now or going out. It is -gravity but for a
// step's way, and there is none where gravity pulls along a periodic axis. Momentum likewise:
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

struct EnergyBalance {
  double kinetic = 0, inserted_kinetic = 0, removed_kinetic = 0;  // J, all of them
  double gravity = 0, walls = 0, elastic = 0, damping = 0, friction = 0, rolling = 0;
  std::optional<double> potential;
  double time_stepping = 0, energy_residual = 0;
  double turned_over = 0;          // J: |gravity| + |walls| + inserted
  Vec3 momentum_residual{};        // N s
  double impulse_turned_over = 0;  // N s

  double energy_residual_share() const { return turned_over > 0 ? std::abs(energy_residual) / turned_over : 0; }
  double momentum_residual_share() const {
    return impulse_turned_over > 0 ? norm(momentum_residual) / impulse_turned_over : 0;
  }
  bool closes() const {
    return energy_residual_share() <= kLedgerTolerance && momentum_residual_share() <= kLedgerTolerance;
  }
};

// Between two steps, of an engine of this case, which asks for a ledger.
EnergyBalance balance_of(const Engine& engine, const Case& c);

// What to warn of; empty where it closes.
std::string complaint(const EnergyBalance& balance);

nlohmann::json to_json(const EnergyBalance& balance);

}  // namespace scree
