#include "runtime/energy_balance.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace scree {

namespace {

Vec3 vector(const double (&v)[3]) { return {v[0], v[1], v[2]}; }

Vec3 momentum_of(const Engine& e) {
  return {e.sum([](const ParticleState& p) { return p.mass * p.velocity.x; }),
          e.sum([](const ParticleState& p) { return p.mass * p.velocity.y; }),
          e.sum([](const ParticleState& p) { return p.mass * p.velocity.z; })};
}

}  // namespace

EnergyBalance balance_of(const Engine& engine, const Case& c) {
  const EnergyLedger& ledger = engine.counters().ledger;
  const StepLedger& steps = ledger.steps;
  EnergyBalance b;
  b.kinetic = engine.sum(kinetic_energy);
  b.inserted_kinetic = ledger.inserted_kinetic, b.removed_kinetic = ledger.removed_kinetic;
  b.gravity = steps.gravity, b.walls = steps.walls;
  b.damping = steps.damping, b.friction = steps.friction, b.rolling = steps.rolling;
  const double pull[3] = {c.gravity.x, c.gravity.y, c.gravity.z};
  bool falls_round = false;
  for (int a = 0; a < 3; ++a) falls_round |= c.periodic[a] && pull[a] != 0;
  if (!falls_round)
    b.potential = engine.sum([&](const ParticleState& p) { return potential_energy(p, c.gravity); }) +
                  ledger.removed_potential - ledger.inserted_potential;
  b.elastic = engine.elastic_energy();
  b.overlaps_unbooked =
      std::ranges::any_of(c.stages, [](const Stage& stage) { return std::holds_alternative<ReadStage>(stage.action); });
  b.time_stepping = steps.second_order + b.elastic - steps.elastic;
  b.energy_residual = b.kinetic + b.removed_kinetic + b.elastic + b.damping + b.friction + b.rolling -
                      (b.inserted_kinetic + b.gravity + b.walls + b.time_stepping);
  b.turned_over = std::abs(b.gravity) + std::abs(b.walls) + b.inserted_kinetic;

  const Vec3 gravity = vector(steps.gravity_impulse), solid = vector(steps.solid_impulse);
  b.momentum = momentum_of(engine), b.gravity_impulse = gravity, b.solid_impulse = solid;
  b.inserted_momentum = vector(ledger.inserted_momentum), b.removed_momentum = vector(ledger.removed_momentum);
  b.momentum_residual = b.momentum + b.removed_momentum - b.inserted_momentum - gravity - solid;
  b.impulse_turned_over = norm(gravity) + norm(solid) + norm(b.inserted_momentum);
  return b;
}

std::string complaint(const EnergyBalance& b) {
  if (b.closes()) return "";
  return fmt::format(
      "the ledger does not close: {:.2g} of the energy and {:.2g} of the momentum turned over are not "
      "accounted for (tolerance {:g}), {:.2g} of the energy come of finite steps (tolerance {:g}): do not trust the "
      "results, and try a smaller [time] step",
      b.energy_residual_share(), b.momentum_residual_share(), kLedgerTolerance, b.time_stepping_share(),
      kTimeSteppingTolerance);
}

nlohmann::json to_json(const EnergyBalance& b) {
  const auto list = [](const Vec3& v) { return nlohmann::json{v.x, v.y, v.z}; };
  return {{"kinetic_J", b.kinetic},
          {"inserted_kinetic_J", b.inserted_kinetic},
          {"removed_kinetic_J", b.removed_kinetic},
          {"gravity_work_J", b.gravity},
          {"potential_J", b.potential ? nlohmann::json(*b.potential) : nlohmann::json()},
          {"moving_walls_work_J", b.walls},
          {"elastic_J", b.elastic},
          {"dissipated_by_damping_J", b.damping},
          {"dissipated_by_friction_J", b.friction},
          {"dissipated_by_rolling_J", b.rolling},
          {"time_stepping_J", b.time_stepping},
          {"momentum_Ns", list(b.momentum)},
          {"inserted_momentum_Ns", list(b.inserted_momentum)},
          {"removed_momentum_Ns", list(b.removed_momentum)},
          {"gravity_impulse_Ns", list(b.gravity_impulse)},
          {"walls_and_fibres_impulse_Ns", list(b.solid_impulse)},
          {"energy_residual_share", b.energy_residual_share()},
          {"momentum_residual_share", b.momentum_residual_share()},
          {"tolerance", kLedgerTolerance},
          {"time_stepping_share", b.time_stepping_share()},
          {"time_stepping_tolerance", b.overlaps_unbooked ? nlohmann::json() : nlohmann::json(kTimeSteppingTolerance)},
          {"closes", b.closes()}};
}

}  // namespace scree
