// One step of one chunk, forces to new records, in one pass over memory.
#pragma once

#include <chrono>
#include <cstring>

#include "kernels/pair_pass.h"
#include "kernels/solid_pass.h"

namespace scree {

// Takes out of `waiting` the pairs that are nearer than `gap` to touching and gives each to `take`.
template <class L, class Take>
inline void give_up_closer(const ChunkTask<typename L::Real>& task, std::vector<WaitingPair>& waiting, double gap,
                           const Take& take) {
  using F = typename L::F;
  using D = typename L::D;
  const StepSettings& settings = *task.settings;
  const bool wraps = task.contacts->first_wrapping != task.contacts->kNoBlock;
  size_t kept = 0;
  for (size_t first = 0; first < waiting.size(); first += L::width) {
    uint32_t i[L::width], j[L::width];
    for (int k = 0; k < L::width; ++k) {
      const bool real = first + k < waiting.size();
      i[k] = real ? waiting[first + k].i : task.count, j[k] = real ? waiting[first + k].j : task.count + 1;
    }
    const Bodies<L> a = gather_bodies<L>(task.old_particles, i), b = gather_bodies<L>(task.old_particles, j);
    Vec<D> d = a.position - b.position;
    if (wraps) d = minimum_image(d, settings.period, settings.inverse_period);
    const D reach = L::widen(a.radius) + L::widen(b.radius) + D(gap);
    const unsigned close = L::bits(L::narrow(fma(reach, reach, -dot(d, d))) >= F(0));
    for (int k = 0; k < L::width && first + k < waiting.size(); ++k) {
      if (close >> k & 1u)
        take(i[k], j[k]);
      else
        waiting[kept++] = {i[k], j[k]};
    }
  }
  waiting.resize(kept);
}

// Moves waiting pairs that have come closer one list on, or into the blocks.
template <class L>
inline void promote_waiting_pairs(const ChunkTask<typename L::Real>& task) {
  auto& contacts = *task.contacts;
  if (task.look == Look::all)
    give_up_closer<L>(task, contacts.far, contacts.middle, [&](uint32_t i, uint32_t j) {
      contacts.near.push_back({i, j});
    });
  if (task.look != Look::none)
    give_up_closer<L>(task, contacts.near, contacts.inner, [&](uint32_t i, uint32_t j) { contacts.append(i, j); });
}

// A kick's work by gravity, and what contact forces do beyond their power at the old velocity times the kick.
template <class Real>
inline void add_motion(const Particle<Real>& p, const Real* row, const StepSettings& s, StepLedger& ledger) {
  const double mass = 1 / static_cast<double>(p.inverse_mass), kick = s.kick;
  const double inertia = 0.4 * mass * static_cast<double>(p.radius) * static_cast<double>(p.radius);
  const double velocity[3] = {p.vx, p.vy, p.vz};
  for (int a = 0; a < 3; ++a) {
    const double force = row[a], torque = row[3 + a], weight = mass * s.gravity[a];
    ledger.gravity += weight * (velocity[a] + 0.5 * kick * (force / mass + s.gravity[a])) * kick;
    ledger.second_order += 0.5 * kick * kick * (force * (force / mass + s.gravity[a]) + torque * torque / inertia);
    ledger.gravity_impulse[a] += weight * kick;
  }
}

// Leapfrog: v(t + dt/2) = v(t - dt/2) + dt a(t), x(t + dt) = x(t) + dt v(t + dt/2). Same positions and half-step
// velocities as velocity Verlet; the first step of a run kicks by dt/2 only.
template <class Real, bool ledger>
inline void integrate(const ChunkTask<Real>& task, ChunkOutcome& outcome) {
  const StepSettings& s = *task.settings;
  const Real kick = static_cast<Real>(s.kick);
  const Vec<Real> gravity_kick{static_cast<Real>(s.gravity[0] * s.kick), static_cast<Real>(s.gravity[1] * s.kick),
                               static_cast<Real>(s.gravity[2] * s.kick)};
  const Real limit2 = static_cast<Real>(s.speed_limit * s.speed_limit);
  Real max_speed2 = 0;
  bool bad = false;
  for (uint32_t k = task.begin; k < task.end; ++k) {
    Particle<Real> p = task.old_particles[k];
    const Real* row = task.rows + 8 * static_cast<size_t>(k - task.begin);
    const Real linear = kick * p.inverse_mass;
    const Real angular = linear * (Real(2.5) / (p.radius * p.radius));  // I = 2/5 m R^2
    if constexpr (ledger) add_motion(p, row, s, outcome.ledger);
    // What gravity and contacts give first: at rest they cancel, and the velocity is rounded once, by next to nothing.
    p.vx += fma(linear, row[0], gravity_kick.x);
    p.vy += fma(linear, row[1], gravity_kick.y);
    p.vz += fma(linear, row[2], gravity_kick.z);
    p.wx = fma(angular, row[3], p.wx);
    p.wy = fma(angular, row[4], p.wy);
    p.wz = fma(angular, row[5], p.wz);
    p.x = fma(s.dt, static_cast<double>(p.vx), p.x);
    p.y = fma(s.dt, static_cast<double>(p.vy), p.y);
    p.z = fma(s.dt, static_cast<double>(p.vz), p.z);
    const Real speed2 = dot(Vec<Real>{p.vx, p.vy, p.vz}, Vec<Real>{p.vx, p.vy, p.vz});
    bad |= !(speed2 <= limit2);  // NaN too
    max_speed2 = max(max_speed2, speed2);
    task.new_particles[k] = p;
  }
  outcome.max_speed = std::sqrt(static_cast<double>(max_speed2));
  outcome.too_fast = bad;
}

// Times the parts of a chunk's step, one after the other.
class PartClock {
 public:
  PartClock(bool on, ChunkOutcome& outcome) : on_(on), outcome_(outcome) {
    if (on_) last_ = Clock::now();
  }
  void ends(StepPart part) {
    if (!on_) return;
    const Clock::time_point now = Clock::now();
    outcome_.seconds[static_cast<int>(part)] = std::chrono::duration<double>(now - last_).count();
    last_ = now;
  }

 private:
  using Clock = std::chrono::steady_clock;
  bool on_;
  ChunkOutcome& outcome_;
  Clock::time_point last_;
};

template <class L, class Traits>
ChunkOutcome step_chunk(const ChunkTask<typename L::Real>& task) {
  using Real = typename L::Real;
  ChunkOutcome outcome;
  PartClock clock(task.settings->profile, outcome);
  promote_waiting_pairs<L>(task);
  outcome.checked_near = task.look != Look::none;
  clock.ends(StepPart::near_check);
  std::memset(task.rows, 0, (task.end - task.begin + 1) * size_t{8} * sizeof(Real));
  const PassOutcome pairs = pair_pass<L, Traits>(task);
  clock.ends(StepPart::pairs);
  const PassOutcome solids = solid_pass<L, Traits>(task);
  clock.ends(StepPart::solids);
  integrate<Real, Traits::ledger>(task, outcome);
  clock.ends(StepPart::integration);
  outcome.max_pair_overlap = pairs.max_overlap, outcome.max_solid_overlap = solids.max_overlap;
  if constexpr (Traits::ledger)
    outcome.ledger.add(pairs.ledger, task.settings->kick), outcome.ledger.add(solids.ledger, task.settings->kick);
  return outcome;
}

}  // namespace scree
