// A case as a user describes it, after reading: plain values, SI units, defaults filled in. Nothing here runs.
// read_case() (runtime/case_reader.h) makes one from TOML; scenes in tests and benchmarks fill one by hand.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "geometry/solid.h"
#include "kernels/contact_law.h"
#include "runtime/render/picture_request.h"
#include "runtime/schedule.h"

namespace scree {

struct Material {
  std::string name;
  double density = 0;         // kg/m3; 0: not given, allowed for walls only
  double youngs_modulus = 0;  // Pa
  double poisson_ratio = 0;   // -1 < nu <= 0.5
};

// What belongs to a pair of materials. `first`, `second` index Case::materials, unordered.
struct MaterialPair {
  uint32_t first = 0, second = 0;
  double restitution = 0;       // 0..1
  double sliding_friction = 0;  // >= 0
  double rolling_friction = 0;  // >= 0
};

enum class ContactModel { hertz_mindlin };  // Hertz normal force, Mindlin tangential force with history
enum class Precision { mixed, reference };  // reference: everything in double, scalar; slow, the oracle

struct ContactSettings {
  ContactModel model = ContactModel::hertz_mindlin;
  RollingModel rolling = RollingModel::epsd2;
  bool limit_attraction = false;  // clamp F_n >= 0
  Precision precision = Precision::mixed;
};

// Diameters, m. One diameter is a list with one entry.
struct SizeDistribution {
  enum class Kind { list, normal, lognormal } kind = Kind::list;
  std::vector<double> diameters;  // list
  std::vector<double> fractions;  // list: mass or number fractions, sum 1 after reading
  bool fractions_by_mass = true;  // list
  double mean = 0;                // normal: mean; lognormal: median
  double deviation = 0;           // normal: standard deviation, m; lognormal: standard deviation of ln d
  double min = 0, max = 0;        // m, truncation (required for normal and lognormal)
};

// A kind of particle.
struct ParticleKind {
  std::string name;
  uint32_t material = 0;
  SizeDistribution size;
};

// A region that particles are placed in.
struct Region {
  std::string name;
  enum class Shape { box, cylinder, frustum } shape = Shape::box;
  Vec3 min{}, max{};              // box: corners
  Vec3 base{}, axis{0, 0, 1};     // cylinder: centre of the bottom, unit axis
  double radius = 0, height = 0;  // cylinder; frustum uses height too
  double bottom_x = 0, bottom_y = 0, top_x = 0,
         top_y = 0;  // frustum: side lengths at base.z and base.z + height; centred on base, axis z
};

// The share of each kind in what a stage inserts, by mass.
struct Mixture {
  std::vector<uint32_t> kinds;
  std::vector<double> mass_fractions;
};

// Stages run in the order of the file.
struct FillStage {                // place at once, without overlaps, then the next stage lets them fall
  std::vector<uint32_t> regions;  // filled one after the other, each up to solid_fraction of its free space
  Mixture mixture;
  double mass = 0;               // kg; 0: use count
  uint64_t count = 0;            // 0 and mass 0: as many as fit
  double solid_fraction = 0.55;  // what the placement aims at, 0 < phi <= 0.6
  Vec3 velocity{0, 0, 0};
};
struct PourStage {  // insert from a region by rate until mass or count is reached
  uint32_t region = 0;
  Mixture mixture;
  double rate = 0;  // kg/s
  double mass = 0;
  uint64_t count = 0;
  Vec3 velocity{0, 0, 0};
  double solid_fraction = 0.3;  // of the region at each insertion
};
struct ReadStage {    // particles from a CSV file with a header: x, y, z, radius and optional vx, vy, vz, kind
  std::string file;   // full path
  uint32_t kind = 0;  // of particles whose row names none
};
struct SettleStage {                       // run until at rest, or for `time`
  double max_time = 0;                     // s; fixed length if kinetic_energy_per_particle is 0
  double kinetic_energy_per_particle = 0;  // J
  double min_time = 0;                     // s
};
struct OpenStage {  // remove walls by name
  std::vector<std::string> walls;
};
struct DrainStage {                // run until one of the given ends is met
  double max_time = 0;             // s, 0: none
  double discharged_fraction = 0;  // 0..1 of the mass present at the stage's start; 0: none
  double no_flow_time = 0;         // s without discharge; 0: none
};
using StageAction = std::variant<FillStage, PourStage, ReadStage, SettleStage, OpenStage, DrainStage>;
struct Stage {
  std::string name;
  StageAction action;
};

// A plane patch that counts the mass that has passed it along `direction`. Everything beyond it counts as discharged.
// Particles further than `remove_beyond` past an outlet's plane are taken out of the run and counted.
struct Outlet {
  std::string name;
  Vec3 point{}, direction{0, 0, -1};
  double remove_beyond = 0;  // m
};

// Mass between planes, mass flow through a plane: written to mass_flow.csv / <name>.csv.
struct Meter {
  std::string name;
  enum class Kind { mass_in_box } kind = Kind::mass_in_box;
  Vec3 min{}, max{};
};

enum class During { always, drain, steady };  // a drain stage; output.steady_window of it

// Fields on a grid, averaged over what is looked at: runtime/averages.h.
struct AverageSettings {
  std::string name;
  Bounds box{};
  double spacing = 0;  // m, edge of a cell, about: whole cells fill the box
  double width = 0;    // m, half-width of the kernel
  During during = During::drain;
  Moments moments;
};

// Which parts of fibres and walls are touched: runtime/touch_maps.h.
struct TouchSettings {
  bool enabled = false;
  double cell = 0;              // m, edge of a cell, about
  uint64_t around = 12;         // cells round a fibre
  std::vector<uint32_t> walls;  // index into Solid::walls: plane walls that have a map
  During during = During::drain;
  Moments moments;
};

// [output.fields]: field files for ParaView (runtime/field_files.h).
struct FieldSettings {
  Moments moments;                 // none: nothing is written
  std::vector<std::string> write;  // of particle_field_names()
  bool solid = true;               // fibres and walls, too
};

// [output.residence]: how long grains stay in a layer, and where they are left in it (runtime/residence.h).
struct ResidenceSettings {
  bool enabled = false;
  double interval = 1e-3;      // s between looks: the resolution
  double entry = 0, exit = 0;  // m, heights of the layer's top and bottom, entry > exit
  double bin = 0;              // s, of residence.csv; 0: chosen to fit
};

struct OutputSettings {
  double interval = 1e-3;  // s between rows of mass_flow.csv and meters
  double steady_from = 0,
         steady_to = 0;  // s after the drain began: window of the steady flow; 0, 0: found automatically
  bool final_vtk = true;
  bool energy_ledger = false;        // where the energy goes, in summary.json
  std::vector<RunPicture> pictures;  // runtime/render/run_pictures.h
  std::vector<AverageSettings> averages;
  TouchSettings touch;
  FieldSettings fields;
  ResidenceSettings residence;
};

struct CheckpointSettings {
  double interval = 600;  // s of wall-clock time between checkpoints
  uint64_t keep = 2;      // how many stay; 0: none is written
};

struct TimeSettings {
  double step = 0;                 // s; if 0, rayleigh_fraction is used
  double rayleigh_fraction = 0.2;  // of the smallest Rayleigh time
  bool allow_large_step = false;   // go on above half the Rayleigh time
};

struct WatchSettings {
  double max_overlap =
      0.5;  // of R_i + R_j, or of R_i at walls: beyond it the contact is not to be trusted, the run stops
};

struct NeighbourSettings {
  double skin = 0;  // m; 0: chosen by the program
};

struct Case {
  std::string title;
  std::string source;  // path of the file it was read from
  uint64_t seed = 1;
  Vec3 gravity{0, 0, -9.81};
  Bounds domain{};  // particles must stay inside; leaving other than through an outlet is an error
  bool periodic[3] = {false, false, false};
  std::vector<Material> materials;
  std::vector<MaterialPair> pairs;  // every pair that can touch, checked
  ContactSettings contact;
  TimeSettings time;
  NeighbourSettings neighbour;
  WatchSettings watch;
  std::vector<ParticleKind> kinds;
  Solid solid;            // fibres and walls
  struct Fibres {         // what was generated, for the report
    double diameter = 0;  // m; 0: no fibres or several diameters
    double porosity = 0;  // of the union of the fibres in `section`; 0: no fibres or a flat network
    double volume = 0;    // m3 of the union inside `section`
    uint64_t count = 0;
    Bounds section{};  // the lattice's cells; without a lattice the bounds of the fibres' axes
  } fibres;
  std::vector<Region> regions;
  std::vector<Stage> stages;
  std::vector<Outlet> outlets;
  std::vector<Meter> meters;
  OutputSettings output;
  CheckpointSettings checkpoint;
  std::string understood;  // the case as TOML, merged, with defaults filled in: see runtime/case_writer.h
};

}  // namespace scree
