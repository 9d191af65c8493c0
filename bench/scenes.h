// The scenes that the benchmarks time. States that take long to reach are made once per process, small, and tiled to
// any size: every tile is the same settled state, so a million particles need no hours of settling. SI units.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "runtime/engine.h"

namespace scree::bench {

using State = std::vector<ParticleState>;

// Prepared states are read from this folder when they are there and written to it when they are not: for programs that
// want the same state in several processes, or in another code. Without it a state lives as long as the process.
void keep_states_in(const std::filesystem::path& folder);

// Engines that are made from now on take this instruction set. Throws std::invalid_argument where it is not available.
void use_isa(const std::string& name);

// x, y, z, r, vx, vy, vz with all digits: reading gives the same bits.
void write_state_csv(const std::filesystem::path& path, const State& state);

// An engine with the case's outlets at work, `state` in it and `steps` steps done.
std::unique_ptr<Engine> started_engine(const Case& c, const State& state, int steps);

inline constexpr double kDiameter = 4e-4;       // m, the paper's particles
inline constexpr uint64_t kTileGrains = 10504;  // in every tile, so that beds of equal tiles have equal numbers

// The paper's materials and contact law (Kaur et al. 2023, Table 2), without particles or walls.
Case paper_case();

// A bed on a floor, periodic in x and y: `tiles` x `tiles` copies of one.
struct Bed {
  std::string name;
  std::vector<double> diameters;  // m, in equal numbers
  double side;                    // m, of a tile
  double fill_height;             // m, that a tile's grains fall from
};
const Bed& monodisperse();
const Bed& polydisperse();  // 1:3, the smallest is the paper's grain: the same time step is as fine as for it
Case bed_case(const Bed& bed, int tiles);
State settled_bed(const Bed& bed, int tiles);

// cases/olhx/mini_liggghts.toml with the lid open, and its grains above the exit 0.2 s later: the lattice is half full
// and flowing, the first grains have left.
Case drain_case();
State drain_in_flow();

// cases/olhx/demo.toml with its seal open, and its grains settled above the exit before that.
Case demo_case();
State demo_charged();

// The paper's full lattice and hopper (cases/olhx/paper_088.toml, lid included) packed with tiles of the settled bed,
// stacked from the height `bottom` to `top`; grains that a fibre or wall would cut are left out.
enum class Fibres { with, without };
Case paper_hopper_case(Fibres fibres);
State stacked_grains(const Case& c, double bottom, double top);

// The hopper without the lattice, 15 ms after its lid was opened.
Case open_hopper_case();
State hopper_in_flow();

}  // namespace scree::bench
