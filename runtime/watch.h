// What a run watches now and then, beside what every step checks: that no particle is lost, that kinetic energy does
// not come from nowhere, and that the time step resolves contacts at the speeds and spins that are seen. Reads only; a
// look costs less than a step.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runtime/engine.h"

namespace scree {

// A look at the whole system. SI units.
struct EnergyLook {
  double time = 0, kinetic = 0, mass = 0;
  std::optional<double> elastic;  // of the contacts' normal springs; none just after an insertion
  double max_speed = 0;
  uint64_t particles = 0, inserted = 0;
};

// What kinetic energy K may grow to between two looks, bounded from above: what it was, what the contacts held (their
// tangential and rolling springs by the laws' limits), what walls that move and particles that came in give, and
// gravity's work, whose power is sum m g.v <= g sqrt(2 M K) (Cauchy and Schwarz), so that sqrt(K) grows by
// g dt sqrt(M / 2) at most. Twice that stops a run: it never stops a sound one, and sees what blows up as a whole; a
// single particle that is shot away is caught by the limits on its speed and overlap.
class EnergyBudget {
 public:
  explicit EnergyBudget(const Case& c);
  bool compares(const EnergyLook& before, const EnergyLook& now) const;
  double most_after(const EnergyLook& before, const EnergyLook& now) const;  // J

 private:
  double gravity_, wall_speed_, inserted_speed_, springs_, heaviest_;
  bool reads_;  // particles come from files, as fast and as deep in one another as those say
};

// That every particle that went in is there or left through an outlet. Throws RunError.
void check_count(const Engine& engine);

class Watch {
 public:
  explicit Watch(const Case& c);

  // Every few hundred steps it looks; in between it returns at once, unless it `must`: a state that is to be kept is
  // looked at first, as whoever goes on from it knows of nothing before. Such a look is held against the same look
  // before as the next regular one will be. Returns what to warn of, each thing once. Throws RunError when the run is
  // not to be trusted.
  std::vector<std::string> look(const Engine& engine, bool must = false);

  // How near kinetic energy came to what would have stopped the run, since it began or was gone on with.
  uint64_t energy_looks() const { return energy_looks_; }
  double largest_energy_share() const { return largest_share_; }

 private:
  void check_energy(const Engine& engine, bool regular);
  std::vector<std::string> check_step(const Engine& engine);
  std::vector<std::string> check_spin(const Engine& engine);

  const Case& case_;
  EnergyBudget budget_;
  double wall_speed_;  // m/s
  std::optional<EnergyLook> last_;
  uint64_t next_step_ = 0, energy_looks_ = 0;
  double largest_share_ = 0;
  bool warned_ = false, warned_of_spin_ = false;
};

}  // namespace scree
