// The engine as the stages see it: particles go in, steps are taken, sums come out. One implementation per storage
// precision (runtime/domain.h); nothing here depends on it. SI units.
//
// A *domain* owns a stretch of the Morton curve. Here it is the whole curve; nothing outside assumes so: ids are
// global, and sums over particles go through sum(), insertion and removal through insert() and the removal rule.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <ranges>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "kernels/array.h"
#include "kernels/step_outcome.h"
#include "runtime/case.h"

namespace scree {

class StateWriter;  // runtime/state_archive.h
class StateReader;

// A particle as the outside sees it. Velocities are half a step behind positions (leapfrog), except before the first
// step.
struct ParticleState {
  Vec3 position{}, velocity{}, spin{};
  double radius = 0, mass = 0;
  uint32_t kind = 0;
  uint64_t id = 0;  // given by the engine at insertion
};

// J, of translation and spin.
inline double kinetic_energy(const ParticleState& p) {
  return 0.5 * p.mass * (dot(p.velocity, p.velocity) + 0.4 * p.radius * p.radius * dot(p.spin, p.spin));
}

// J, -m g.x.
inline double potential_energy(const ParticleState& p, const Vec3& gravity) {
  return -p.mass * dot(gravity, p.position);
}

// A contact as the outside sees it.
struct ContactState {
  size_t i = 0;             // index into particles()
  size_t j = 0;             // the other particle's, or the index of a primitive of Case::solid
  bool with_solid = false;  // j is a primitive
  double overlap = 0;       // m
  Vec3 normal{};            // unit, from j to i
  Vec3 point{};             // m; of a periodic pair beside i
  Vec3 force{};             // N, on i; -force on j
  Vec3 slip{};              // m/s, tangential velocity of i relative to j at the contact
  double elastic_energy{};  // J, of the normal spring
};

// What the contacts of a moment come to for one particle.
// Of the particle with radius R at x:
//   force          F = sum f_c over all its contacts, N, without gravity
//   coordination   particles that touch it
//   wall_contacts  fibres and wall surfaces that touch it
//   stress         s = -1/V sum sym((x_c - x) (x) f_c) over all its contacts, Pa; V = 4/3 pi R^3, x_c the contact's
//                  point, sym(A) = (A + A^T) / 2, which leaves out the contacts' torque. Compression is positive:
//                  p = (s_xx + s_yy + s_zz) / 3. A packing of solid fraction phi bears phi times its mean.
// Source of the stress: Christoffersen, Mehrabadi, Nemat-Nasser, J. Appl. Mech. 48 (1981) 339, for one particle.
struct ContactSum {
  Vec3 force{0, 0, 0};
  std::array<float, 6> stress{};  // xx, yy, zz, xy, yz, xz
  uint16_t coordination = 0, wall_contacts = 0;
};

// Of the smallest radius: a particle that moves further in one step stops the run.
inline constexpr double kMaxTravelShare = 0.2;

// The run cannot go on: what happened, where, and what to change.
struct RunError : std::runtime_error {
  using std::runtime_error::runtime_error;
  RunError(const std::string& what, const Vec3& place) : std::runtime_error(what), where(place) {}
  std::optional<Vec3> where;  // m: what lies round it is written out beside the results
};

// What goes into and out of the energy and momentum of a run's particles, since its beginning.
struct EnergyLedger {
  StepLedger steps;
  double inserted_kinetic = 0, removed_kinetic = 0;            // J
  double inserted_potential = 0, removed_potential = 0;        // J, by height where they went in and out
  double inserted_momentum[3] = {}, removed_momentum[3] = {};  // N s

  template <class Visit>
  static void for_each_field(const Visit& visit) {
    visit("steps", &EnergyLedger::steps);
    visit("inserted_kinetic", &EnergyLedger::inserted_kinetic);
    visit("removed_kinetic", &EnergyLedger::removed_kinetic);
    visit("inserted_potential", &EnergyLedger::inserted_potential);
    visit("removed_potential", &EnergyLedger::removed_potential);
    visit("inserted_momentum", &EnergyLedger::inserted_momentum);
    visit("removed_momentum", &EnergyLedger::removed_momentum);
  }
};

// Particles with ids from `first_id` on went in after `step` steps.
struct Insertion {
  uint64_t first_id = 0, step = 0;
};

struct EngineCounters {
  uint64_t steps = 0, rebuilds = 0, near_checks = 0, particle_steps = 0, inserted = 0, removed = 0;
  std::vector<double> removed_mass;  // kg, by what the removal rule said
  double step_seconds = 0, history_seconds = 0, sort_seconds = 0, pair_search_seconds = 0, solid_search_seconds = 0;
  EnergyLedger ledger;  // when the case asks for one
  // Of all threads together, only when EngineOptions::profile is set.
  double near_check_seconds = 0, pair_seconds = 0, solid_seconds = 0, integration_seconds = 0;

  template <class Visit>
  static void for_each_field(const Visit& visit) {
    visit("steps", &EngineCounters::steps), visit("rebuilds", &EngineCounters::rebuilds);
    visit("near_checks", &EngineCounters::near_checks), visit("particle_steps", &EngineCounters::particle_steps);
    visit("inserted", &EngineCounters::inserted), visit("removed", &EngineCounters::removed);
    visit("removed_mass", &EngineCounters::removed_mass);
    visit("step_seconds", &EngineCounters::step_seconds), visit("history_seconds", &EngineCounters::history_seconds);
    visit("sort_seconds", &EngineCounters::sort_seconds);
    visit("pair_search_seconds", &EngineCounters::pair_search_seconds);
    visit("solid_search_seconds", &EngineCounters::solid_search_seconds);
    visit("ledger", &EngineCounters::ledger);
    visit("near_check_seconds", &EngineCounters::near_check_seconds);
    visit("pair_seconds", &EngineCounters::pair_seconds), visit("solid_seconds", &EngineCounters::solid_seconds);
    visit("integration_seconds", &EngineCounters::integration_seconds);
  }
};

struct EngineOptions {
  std::string isa;                       // empty: the best available
  bool brute_force_solid = false;        // the oracle's twin of the Embree index
  double skin = 0;                       // m; 0: from speeds and sizes
  bool profile = false;                  // time the parts of the step
  uint64_t list_check_interval = 20000;  // steps between proofs that no contact is missing from the lists; 0: none
};

class Engine {
 public:
  virtual ~Engine() = default;

  virtual void insert(std::span<const ParticleState> particles) = 0;  // ids are given in order
  virtual void open_walls(const std::vector<uint32_t>& walls) = 0;    // removes primitives of these parts of the solid

  // One step of the case's dt. Throws RunError when the state is not to be trusted: a particle too fast, NaN, an
  // overlap beyond the limit, a particle outside the domain or going through the solid, a contact missing from the
  // lists.
  virtual void step() = 0;

  // A particle for which this gives k >= 0 is taken out at the next list rebuild and counted in removed_mass[k].
  using Removal = std::function<int(const ParticleState&)>;
  virtual void set_removal(Removal leaves) = 0;

  virtual size_t count() const = 0;
  virtual double time() const = 0;  // s since the run began
  virtual double dt() const = 0;
  virtual double max_speed() const = 0;    // m/s, in the last step
  virtual double max_overlap() const = 0;  // in the last step, share of the radius (pairs: of the mean radius)
  virtual double skin() const = 0;
  virtual std::string isa() const = 0;
  virtual const EngineCounters& counters() const = 0;
  virtual size_t bytes() const = 0;         // held in arrays now
  virtual size_t step_traffic() const = 0;  // bytes that a step reads and writes at least: records and active blocks

  // The whole state, lists included: a fresh engine of the same case that loads it goes on to the same bits. Saving
  // changes nothing.
  virtual void save(StateWriter& out) const = 0;
  virtual void load(StateReader& in) = 0;

  // Sum of f over all particles; the same bits for any number of threads.
  virtual double sum(const std::function<double(const ParticleState&)>& f) const = 0;
  virtual ParticleState particle(size_t k) const = 0;        // k < count(), in storage order
  virtual std::vector<ParticleState> particles() const = 0;  // a copy of all: a third of what the engine holds
  virtual uint64_t state_hash() const = 0;  // of ids, positions, velocities, spins; independent of storage order

  // Contacts in the lists that touch now, for tests and averages: (id, id, overlap m).
  struct TouchingPair {
    uint64_t i, j;
    double overlap;
  };
  virtual std::vector<TouchingPair> touching_pairs() const = 0;

  // Every contact that touches now, each once, with the force that the next step will apply; nothing between an
  // insertion or opening of walls and the next step. The same list for any number of threads. Those with solids alone
  // cost a fraction of all.
  enum class Contacts { all, with_solids };
  virtual std::vector<ContactState> contacts(Contacts which = Contacts::all) const = 0;
  virtual bool knows_contacts() const = 0;    // false: between those
  virtual double elastic_energy() const = 0;  // J, of all contacts' normal springs
  // The same list in pieces, so that not all of it is in memory at once (128 B each, some three a particle).
  using SeeContacts = std::function<void(std::span<const ContactState>)>;
  virtual void visit_contacts(const SeeContacts& see, Contacts which = Contacts::all) const = 0;
  // What the same contacts come to for each particle, in storage order; empty while they are not known. The same bits
  // for any number of threads.
  virtual Array<ContactSum> contact_sums() const = 0;

  virtual const std::vector<Insertion>& insertions() const = 0;  // ascending
};

// The particles in storage order, each made as it is looked at: for what goes through them once.
inline auto each_particle(const Engine& engine) {
  return std::views::iota(size_t{0}, engine.count()) |
         std::views::transform([&engine](size_t k) { return engine.particle(k); });
}

std::unique_ptr<Engine> make_engine(const Case& c, const EngineOptions& options = {});

}  // namespace scree
