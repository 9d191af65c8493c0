#include "bench/scenes.h"

#include <algorithm>
#include <map>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/os.h>

#include "geometry/solid_index.h"
#include "geometry/walls.h"
#include "kernels/step_kernels.h"
#include "runtime/case_physics.h"
#include "runtime/case_reader.h"
#include "runtime/csv_particles.h"
#include "runtime/mass_flow.h"
#include "runtime/placement.h"

namespace scree::bench {
namespace {

constexpr double kDensity = 3071;          // kg/m3, the paper's particles
constexpr int kStepsToSettle = 40000;      // 0.2 s: a tile falls a few diameters
constexpr int kStepsToSettleDemo = 20000;  // as long as its stage says
constexpr double kExit = -30e-3;           // m, exit plane of the small lattice
constexpr double kLid = 100e-3;            // m, height of the paper's lid

std::filesystem::path states_folder;
EngineOptions engine_options;

// What a CSV file can hold: no spins; the mass follows from the radius. Then a state that was read back is the same.
State normalised(State state) {
  for (ParticleState& p : state) {
    p.spin = {0, 0, 0}, p.kind = 0, p.id = 0;
    p.mass = sphere_mass(p.radius, kDensity);
  }
  return state;
}

State read_state_csv(const std::filesystem::path& path) {
  State state;
  for (const CsvParticle& p : read_particles_csv(path.string()))
    state.push_back({p.position, p.velocity, {}, p.radius, 0, 0, 0});
  return normalised(std::move(state));
}

template <class Make>
const State& prepared(const std::string& name, const Make& make) {
  static std::map<std::string, State> states;
  if (const auto known = states.find(name); known != states.end()) return known->second;
  const std::filesystem::path file = states_folder / (name + ".csv");
  if (!states_folder.empty() && std::filesystem::exists(file)) return states[name] = read_state_csv(file);
  State state = normalised(make());
  if (!states_folder.empty()) write_state_csv(file, state);
  return states[name] = std::move(state);
}

void remove_primitives(Case& c, const auto& unwanted) { std::erase_if(c.solid.primitives, unwanted); }

void open(Case& c, const std::string& wall) {
  remove_primitives(c, [&](const Primitive& p) { return c.solid.walls[p.wall] == wall; });
}

Case olhx_case(const std::string& file) { return read_case(std::string(SCREE_SOURCE_DIR) + "/cases/olhx/" + file); }

State settle_tile(const Bed& bed) {
  const Case c = bed_case(bed, 1);
  Case filled = c;
  Region box;
  box.name = "bed";
  box.max = {bed.side, bed.side, bed.fill_height};
  filled.regions = {box};
  FillStage stage;
  stage.regions = {0}, stage.mixture = {{0}, {1.0}}, stage.solid_fraction = 0.55, stage.count = kTileGrains;
  return started_engine(c, fill(filled, stage, c.solid, {}, 1), kStepsToSettle)->particles();
}

}  // namespace

void keep_states_in(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  states_folder = folder;
}

void use_isa(const std::string& name) {
  select_kernels<float>(name, {});
  engine_options.isa = name;
}

void write_state_csv(const std::filesystem::path& path, const State& state) {
  auto file = fmt::output_file(path.string());
  file.print("x,y,z,r,vx,vy,vz\n");
  for (const ParticleState& p : state)
    file.print("{},{},{},{},{},{},{}\n", p.position.x, p.position.y, p.position.z, p.radius, p.velocity.x, p.velocity.y,
               p.velocity.z);
}

std::unique_ptr<Engine> started_engine(const Case& c, const State& state, int steps) {
  auto engine = make_engine(c, engine_options);
  if (!c.outlets.empty())
    engine->set_removal([outlets = c.outlets](const ParticleState& p) {
      for (size_t k = 0; k < outlets.size(); ++k)
        if (beyond(outlets[k], p, outlets[k].remove_beyond)) return static_cast<int>(k);
      return -1;
    });
  engine->insert(state);
  for (int k = 0; k < steps; ++k) engine->step();
  return engine;
}

Case paper_case() {
  Case c;
  c.materials = {{"carbobead", kDensity, 1e7, 0.28}, {"steel", 0, 1e7, 0.28}};
  c.pairs = {{0, 0, 0.52, 0.53, 0.37}, {0, 1, 0.41, 0.5, 0.41}};
  ParticleKind grain;
  grain.name = "grain";
  grain.size.diameters = {kDiameter}, grain.size.fractions = {1};
  c.kinds = {grain};
  c.time.step = 5e-6;
  return c;
}

// ---- settled beds

const Bed& monodisperse() {
  static const Bed bed{"settled_tile", {kDiameter}, 25 * kDiameter, 16 * kDiameter};
  return bed;
}

const Bed& polydisperse() {
  static const Bed bed{"polydisperse_tile", {4e-4, 6e-4, 8e-4, 10e-4, 12e-4}, 20e-3, 22e-3};
  return bed;
}

Case bed_case(const Bed& bed, int tiles) {
  Case c = paper_case();
  SizeDistribution& size = c.kinds[0].size;
  size.diameters = bed.diameters, size.fractions_by_mass = false;
  size.fractions.assign(bed.diameters.size(), 1.0 / static_cast<double>(bed.diameters.size()));
  const double side = bed.side * tiles;
  c.domain = {{0, 0, -bed.diameters.back()}, {side, side, 4 * bed.fill_height}};
  c.periodic[0] = c.periodic[1] = true;
  c.solid.walls = {"floor"};
  c.solid.primitives = rectangle({0, 0, 0}, {side, 0, 0}, {0, side, 0}, {1, 0});
  return c;
}

State settled_bed(const Bed& bed, int tiles) {
  const State& tile = prepared(bed.name, [&] { return settle_tile(bed); });
  State all;
  all.reserve(tile.size() * static_cast<size_t>(tiles) * static_cast<size_t>(tiles));
  for (int y = 0; y < tiles; ++y)
    for (int x = 0; x < tiles; ++x)
      for (ParticleState p : tile) {
        p.position += {x * bed.side, y * bed.side, 0};
        all.push_back(p);
      }
  return all;
}

// ---- the small lattice

Case drain_case() {
  Case c = olhx_case("mini_liggghts.toml");
  open(c, "lid");
  return c;
}

State drain_in_flow() {
  return prepared("drain_in_flow", [] {
    const Case c = olhx_case("mini_liggghts.toml");
    const State start = read_state_csv(std::get<ReadStage>(c.stages.front().action).file);
    const State at_rest = started_engine(c, start, 2000)->particles();  // as the reference was started
    State flowing = started_engine(drain_case(), at_rest, 40000)->particles();
    std::erase_if(flowing, [](const ParticleState& p) { return p.position.z < kExit; });
    return flowing;
  });
}

Case demo_case() {
  Case c = olhx_case("demo.toml");
  open(c, "seal");
  return c;
}

State demo_charged() {
  return prepared("demo_charged", [] {
    const Case c = olhx_case("demo.toml");
    const auto& charge = std::get<FillStage>(c.stages.front().action);
    return started_engine(c, fill(c, charge, c.solid, {}, c.seed), kStepsToSettleDemo)->particles();
  });
}

// ---- the paper's lattice and hopper

Case paper_hopper_case(Fibres fibres) {
  Case c = olhx_case("paper_088.toml");
  if (fibres == Fibres::without)
    remove_primitives(c, [](const Primitive& p) { return std::holds_alternative<Segment>(p.skeleton); });
  return c;
}

State stacked_grains(const Case& c, double bottom, double top) {
  const State layer = settled_bed(monodisperse(), 1);
  double height = 0;
  for (const ParticleState& p : layer) height = std::max(height, p.position.z + p.radius);
  const double side = monodisperse().side;
  const auto index = make_embree_index(c.solid);
  State grains;
  std::vector<uint32_t> touched;
  for (double z = bottom; z < top; z += height)
    for (double x = -25e-3; x < 24e-3; x += side)  // the column over the lattice, 50 x 10 mm
      for (ParticleState p : layer) {
        p.position += {x, -0.5 * side, z};
        touched.clear();
        index->query(p.position, p.radius, touched);
        if (touched.empty() && p.position.z < top) grains.push_back(p);
      }
  return grains;
}

Case open_hopper_case() {
  Case c = paper_hopper_case(Fibres::without);
  open(c, "lid");
  return c;
}

State hopper_in_flow() {
  return prepared("hopper_in_flow", [] {
    const Case closed = paper_hopper_case(Fibres::without);
    const State at_rest = started_engine(closed, stacked_grains(closed, kLid + 5e-6, kLid + 6e-3), 1000)->particles();
    return started_engine(open_hopper_case(), at_rest, 3000)->particles();
  });
}

}  // namespace scree::bench
