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
  double max_speed = 0;
  double max_overlap = 0;  // share of the radius
  uint64_t particles = 0, inserted = 0;
};

// What kinetic energy may grow by between two looks: gravity's work along the particles' way, what walls that move
// give, and what elastic contacts held, each bounded from above (all particles as fast as the fastest, ten contacts a
// particle as deep as the deepest). So it never stops a sound run, and sees what blows up as a whole; a single particle
// that is shot away is caught by the limits on its speed and overlap.
class EnergyBudget {
 public:
  explicit EnergyBudget(const Case& c);
  double most_after(const EnergyLook& before, const EnergyLook& now) const;  // J

 private:
  double gravity_, wall_speed_, stiffness_, radius_;
};

// That every particle that went in is there or left through an outlet. Throws RunError.
void check_count(const Engine& engine);

class Watch {
 public:
  explicit Watch(const Case& c);

  // Every few hundred steps it looks; in between it returns at once. Returns what to warn of, each thing once. Throws
  // RunError when the run is not to be trusted.
  std::vector<std::string> look(const Engine& engine);

 private:
  void check_energy(const Engine& engine);
  std::vector<std::string> check_step(const Engine& engine);
  std::vector<std::string> check_spin(const Engine& engine);

  const Case& case_;
  EnergyBudget budget_;
  double wall_speed_;  // m/s
  std::optional<EnergyLook> last_;
  uint64_t next_step_ = 0;
  bool warned_ = false, warned_of_spin_ = false;
};

}  // namespace scree
