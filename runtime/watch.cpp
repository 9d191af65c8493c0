#include "runtime/watch.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "runtime/case_physics.h"

namespace scree {

namespace {

constexpr uint64_t kStepsPerLook = 500;
constexpr double kMargin = 2;                   // of the energy's bound, for the laws' own small gains
constexpr double kRestSpeed = 1e-5;             // m/s: below it all is round-off
constexpr double kWarnAt = 0.2, kStopAt = 0.5;  // time step / Hertz contact time

double largest_wall_speed(const Case& c) {
  double speed = 0;
  for (const Primitive& p : c.solid.primitives) speed = std::max(speed, norm(p.velocity));
  return speed;
}

EnergyLook look_at(const Engine& e, const std::optional<EnergyLook>& last) {
  EnergyLook now{e.time(), e.sum(kinetic_energy), 0, {}, e.max_speed(), e.count(), e.counters().inserted};
  const bool same = last && last->particles == now.particles && last->inserted == now.inserted;
  now.mass = same ? last->mass : e.sum([](const ParticleState& p) { return p.mass; });
  if (e.knows_contacts()) now.elastic = e.elastic_energy();
  return now;
}

ParticleState fastest_of(const Engine& e) {
  const auto all = each_particle(e);
  return *std::ranges::max_element(all, {}, [](const ParticleState& p) { return dot(p.velocity, p.velocity); });
}

}  // namespace

EnergyBudget::EnergyBudget(const Case& c)
    : gravity_(norm(c.gravity)), wall_speed_(largest_wall_speed(c)), inserted_speed_(0), heaviest_(0), reads_(false) {
  double friction = 0, density = 0;
  for (const MaterialPair& pair : c.pairs) friction = std::max(friction, pair.sliding_friction);
  for (const ParticleKind& kind : c.kinds) density = std::max(density, c.materials[kind.material].density);
  for (const Stage& stage : c.stages) {
    if (const auto* pour = std::get_if<PourStage>(&stage.action))
      inserted_speed_ = std::max(inserted_speed_, norm(pour->velocity));
    if (const auto* fill = std::get_if<FillStage>(&stage.action))
      inserted_speed_ = std::max(inserted_speed_, norm(fill->velocity));
    reads_ |= std::holds_alternative<ReadStage>(stage.action);
  }
  heaviest_ = density * 4.0 / 3 * std::numbers::pi * std::pow(largest_radius(c), 3);
  // In shares of the normal spring's energy, 2/5 F d: that, at most 0.6 in EPSD2's rolling spring (torque mu_r R F,
  // stiffness 2.25 k mu_r^2 R^2, k at least F / d), and mu^2 E* / (4.8 G*) in Mindlin's at mu F: at most 1.3 mu^2.
  springs_ = 1.6 + 1.3 * friction * friction;
}

bool EnergyBudget::compares(const EnergyLook& before, const EnergyLook& now) const {
  return before.particles > 0 && before.elastic && (before.inserted == now.inserted || !reads_);
}

double EnergyBudget::most_after(const EnergyLook& before, const EnergyLook& now) const {
  const double dt = now.time - before.time;
  const double came = heaviest_ * static_cast<double>(now.inserted - before.inserted), mass = before.mass + came;
  // A collision with a wall at speed w turns v into v + 2 w at most.
  const double speed = std::max(before.max_speed, now.max_speed) + gravity_ * dt;
  const double from_walls = 2 * mass * wall_speed_ * (speed + wall_speed_);
  const double at_rest = 0.5 * mass * kRestSpeed * kRestSpeed;
  const double inserted = 0.5 * came * inserted_speed_ * inserted_speed_;
  const double without_gravity =
      before.kinetic + springs_ * before.elastic.value_or(0) + from_walls + inserted + at_rest;
  return kMargin * std::pow(std::sqrt(without_gravity) + gravity_ * dt * std::sqrt(0.5 * mass), 2);
}

void check_count(const Engine& engine) {
  const EngineCounters& k = engine.counters();
  if (k.inserted == k.removed + engine.count()) return;
  throw RunError(fmt::format(
      "{} particles went in, {} left through outlets, {} are left at t = {:.6g} s: {} lost. This is an error of the "
      "program, please report it with the case",
      k.inserted, k.removed, engine.count(), engine.time(),
      static_cast<int64_t>(k.inserted) - static_cast<int64_t>(k.removed) - static_cast<int64_t>(engine.count())));
}

Watch::Watch(const Case& c) : case_(c), budget_(c), wall_speed_(largest_wall_speed(c)) {}

std::vector<std::string> Watch::look(const Engine& engine, bool must) {
  const uint64_t steps = engine.counters().steps;
  const bool regular = steps >= next_step_;
  if (!regular && !must) return {};
  if (regular) next_step_ = steps + kStepsPerLook;
  check_count(engine);
  if (engine.count() == 0) return {};
  check_energy(engine, regular);
  if (last_ && !last_->elastic) next_step_ = steps + 1;  // nothing can be held against it: the next look is soon
  std::vector<std::string> warnings = check_step(engine);
  for (std::string& warning : check_spin(engine)) warnings.push_back(std::move(warning));
  return warnings;
}

void Watch::check_energy(const Engine& engine, bool regular) {
  const EnergyLook now = look_at(engine, last_);
  const EnergyLook before = last_.value_or(now);
  const double most = last_ && budget_.compares(before, now) ? budget_.most_after(before, now) : 0;
  if (most > 0) ++energy_looks_, largest_share_ = std::max(largest_share_, now.kinetic / most);
  if (most > 0 && now.kinetic > most) {
    const ParticleState p = fastest_of(engine);
    throw RunError(
        fmt::format(
            "the kinetic energy of all particles rose from {:.4g} J at t = {:.6g} s to {:.4g} J at t = {:.6g} s, "
            "gravity, moving walls, elastic contacts and what came in account for {:.4g} J at most; the fastest is "
            "particle "
            "{} at ({:.6g}, {:.6g}, {:.6g}) m with {:.4g} m/s: use a smaller [time] step (now {:.4g} s)",
            before.kinetic, before.time, now.kinetic, now.time, most, p.id, p.position.x, p.position.y, p.position.z,
            norm(p.velocity), engine.dt()),
        p.position);
  }
  if (!last_ || (now.elastic && (regular || most == 0))) last_ = now;
}

// Contacts at the largest speed seen last the shortest. Hertz's time falls with speed^(1/5) only, so this speaks when
// the step was chosen by hand or allowed to be large.
std::vector<std::string> Watch::check_step(const Engine& engine) {
  const double speed = engine.max_speed() + wall_speed_;
  if (speed <= kRestSpeed) return {};
  double hertz = 1e300;
  for (const ParticleKind& k : case_.kinds)
    hertz = std::min(hertz, hertz_time(case_.materials[k.material], smallest_radius(case_), speed));
  const double share = engine.dt() / hertz;
  const std::string text = fmt::format(
      "the time step {:.4g} s is {:.2f} of the Hertz contact time {:.4g} s at the largest speed seen, {:.4g} m/s",
      engine.dt(), share, hertz, speed);
  if (share > kStopAt) {
    const ParticleState p = fastest_of(engine);
    throw RunError(fmt::format("{}, of particle {} at ({:.6g}, {:.6g}, {:.6g}) m, t = {:.6g} s; at most {} is allowed: "
                               "use a smaller [time] step",
                               text, p.id, p.position.x, p.position.y, p.position.z, engine.time(), kStopAt),
                   p.position);
  }
  if (share <= kWarnAt || warned_) return {};
  warned_ = true;
  return {fmt::format("{}; above {} contacts are badly resolved, above {} the run stops", text, kWarnAt, kStopAt)};
}

// A spin moves no particle through anything, so one whose surface is faster than a particle may be only resolves
// friction badly: a warning. One that is not a number would spread by the next contact.
std::vector<std::string> Watch::check_spin(const Engine& engine) {
  const double limit = kMaxTravelShare * smallest_radius(case_) / engine.dt();
  const auto surface_speed = [](const ParticleState& p) { return norm(p.spin) * p.radius; };
  const double beyond =
      engine.sum([&](const ParticleState& p) { return surface_speed(p) <= limit ? 0.0 : 1.0; });  // NaN too
  if (beyond == 0) return {};
  const auto all = each_particle(engine);
  const auto nan = std::ranges::find_if(all, [](const ParticleState& p) { return std::isnan(norm(p.spin)); });
  if (nan != all.end()) {
    const ParticleState p = *nan;
    throw RunError(fmt::format("the spin of particle {} at ({:.6g}, {:.6g}, {:.6g}) m is not a number at t = {:.6g} s: "
                               "use a smaller [time] step (now {:.4g} s)",
                               p.id, p.position.x, p.position.y, p.position.z, engine.time(), engine.dt()),
                   p.position);
  }
  if (std::exchange(warned_of_spin_, true)) return {};
  const ParticleState p = *std::ranges::max_element(all, {}, surface_speed);
  return {fmt::format(
      "the surface of particle {} at ({:.6g}, {:.6g}, {:.6g}) m spins at {:.4g} m/s at t = {:.6g} s, more than {:.4g} "
      "m/s = {} radii in a step: friction is badly resolved there; use a smaller [time] step (now {:.4g} s)",
      p.id, p.position.x, p.position.y, p.position.z, surface_speed(p), engine.time(), limit, kMaxTravelShare,
      engine.dt())};
}

}  // namespace scree
