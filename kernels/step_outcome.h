// What a chunk's step reports beside the particles that it moved.
#pragma once

namespace scree {

// What a step did to energy (J) and momentum (N s), or the sum of that over a run: kernels/contact_work.h.
struct StepLedger {
  double elastic = 0;       // into the normal springs of contacts
  double damping = 0;       // out of the motion by normal dashpots
  double friction = 0;      // by tangential springs, dashpots and sliding
  double rolling = 0;       // by rolling resistance
  double walls = 0;         // into it by walls that move
  double gravity = 0;       // into it by gravity
  double second_order = 0;  // what half-step velocities leave of a step's work
  double gravity_impulse[3] = {}, solid_impulse[3] = {};

  template <class Visit>
  static void for_each_field(const Visit& visit) {
    visit("elastic", &StepLedger::elastic), visit("damping", &StepLedger::damping);
    visit("friction", &StepLedger::friction), visit("rolling", &StepLedger::rolling);
    visit("walls", &StepLedger::walls), visit("gravity", &StepLedger::gravity);
    visit("second_order", &StepLedger::second_order);
    visit("gravity_impulse", &StepLedger::gravity_impulse), visit("solid_impulse", &StepLedger::solid_impulse);
  }
  // Adds `times` another.
  void add(const StepLedger& o, double times = 1) {
    elastic += times * o.elastic, damping += times * o.damping, friction += times * o.friction;
    rolling += times * o.rolling, walls += times * o.walls, gravity += times * o.gravity;
    second_order += times * o.second_order;
    for (int a = 0; a < 3; ++a)
      gravity_impulse[a] += times * o.gravity_impulse[a], solid_impulse[a] += times * o.solid_impulse[a];
  }
};

// The parts of a chunk's step that a profile tells apart.
enum class StepPart { near_check, pairs, solids, integration };
inline constexpr int kStepParts = 4;

struct ChunkOutcome {
  double max_speed = 0;             // m/s, of the velocities that moved the particles
  double max_pair_overlap = 0;      // share of the sum of the radii
  double max_solid_overlap = 0;     // share of R_i
  StepLedger ledger;                // J, N s; zero without a ledger
  bool checked_near = false;        // waiting pairs were looked through
  bool too_fast = false;            // a speed above the limit, or NaN
  double seconds[kStepParts] = {};  // by StepPart, of the thread that did it; only in a profile
};

}  // namespace scree
