#include "runtime/watch.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "runtime/case_physics.h"

namespace scree {

namespace {

constexpr uint64_t kStepsPerLook = 500;
constexpr double kMargin = 2;        // of the energy's bound, for the laws' own small gains
constexpr double kContacts = 10;     // of a particle, on average: six of twelve neighbours' halves, and walls
constexpr double kRestSpeed = 1e-5;  // m/s: below it all is round-off
constexpr double kWarnAt = 0.2, kStopAt = 0.5;  // time step / Hertz contact time

double largest_wall_speed(const Case& c) {
  double speed = 0;
  for (const Primitive& p : c.solid.primitives) speed = std::max(speed, norm(p.velocity));
  return speed;
}

EnergyLook look_at(const Engine& e, const std::optional<EnergyLook>& last) {
  EnergyLook now{e.time(), 0, 0, e.max_speed(), e.max_overlap(), e.count(), e.counters().inserted};
  now.kinetic = e.sum(kinetic_energy);
  const bool same = last && last->particles == now.particles && last->inserted == now.inserted;
  now.mass = same ? last->mass : e.sum([](const ParticleState& p) { return p.mass; });
  return now;
}

ParticleState fastest_of(const Engine& e) {
  const auto all = each_particle(e);
  return *std::ranges::max_element(all, {}, [](const ParticleState& p) { return dot(p.velocity, p.velocity); });
}

}  // namespace

EnergyBudget::EnergyBudget(const Case& c)
    : gravity_(norm(c.gravity)), wall_speed_(largest_wall_speed(c)), stiffness_(0), radius_(largest_radius(c)) {
  for (const ParticleKind& kind : c.kinds) {  // against a rigid partner: stiffer than any real one
    const Material& m = c.materials[kind.material];
    stiffness_ = std::max(stiffness_, m.youngs_modulus / (1 - m.poisson_ratio * m.poisson_ratio));
  }
}

double EnergyBudget::most_after(const EnergyLook& before, const EnergyLook& now) const {
  const double dt = now.time - before.time, mass = std::max(before.mass, now.mass);
  const double speed = std::max(before.max_speed, now.max_speed) + gravity_ * dt;
  const double from_gravity = mass * gravity_ * speed * dt;
  // A collision with a wall at speed w turns v into v + 2 w at most.
  const double from_walls = 2 * mass * wall_speed_ * (speed + wall_speed_);
  // Hertz: 8/15 E* sqrt(R*) overlap^(5/2), R* at most R; as much again in the tangential and rolling springs.
  const double overlap = before.max_overlap * radius_;
  const double per_contact = 2 * 8.0 / 15 * stiffness_ * std::sqrt(radius_) * std::pow(overlap, 2.5);
  const double elastic = kContacts * static_cast<double>(before.particles) * per_contact;
  const double at_rest = 0.5 * mass * kRestSpeed * kRestSpeed;
  return kMargin * (before.kinetic + from_gravity + from_walls + elastic + at_rest);
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

std::vector<std::string> Watch::look(const Engine& engine) {
  const uint64_t steps = engine.counters().steps;
  if (steps < next_step_) return {};
  next_step_ = steps + kStepsPerLook;
  check_count(engine);
  if (engine.count() == 0) return {};
  check_energy(engine);
  std::vector<std::string> warnings = check_step(engine);
  for (std::string& warning : check_spin(engine)) warnings.push_back(std::move(warning));
  return warnings;
}

void Watch::check_energy(const Engine& engine) {
  const EnergyLook now = look_at(engine, last_);
  // New particles bring energy of their own: after them, begin again.
  const bool comparable = last_ && last_->inserted == now.inserted && last_->particles > 0;
  if (comparable && now.kinetic > budget_.most_after(*last_, now)) {
    const ParticleState p = fastest_of(engine);
    throw RunError(
        fmt::format(
            "the kinetic energy of all particles rose from {:.4g} J at t = {:.6g} s to {:.4g} J at t = {:.6g} s, "
            "gravity, moving walls and elastic contacts can account for {:.4g} J at most; the fastest is particle "
            "{} at ({:.6g}, {:.6g}, {:.6g}) m with {:.4g} m/s: use a smaller [time] step (now {:.4g} s)",
            last_->kinetic, last_->time, now.kinetic, now.time, budget_.most_after(*last_, now), p.id, p.position.x,
            p.position.y, p.position.z, norm(p.velocity), engine.dt()),
        p.position);
  }
  last_ = now;
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
