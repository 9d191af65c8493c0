// [[stage]]: what happens, in order. Stages are checked against each other as they are read: something must be there to
// drain, a wall can be opened once, and particles are not placed into a region that was filled a moment ago.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "runtime/case_sections.h"
#include "runtime/case_size.h"

namespace scree {
namespace {

constexpr double kMostParticles = 4e9;  // a domain counts them in 32 bits
const Range kMass = positive(1e9, "kg");
const Range kCount = between(1, kMostParticles, "particles");

// What earlier stages have done.
struct Progress {
  bool particles = false;
  std::vector<std::string> opened;
  std::vector<uint32_t> filled;  // regions with fresh particles that no time has passed for
  double expected = 0;           // particles so far
};

Mixture read_mixture(TableReader& t, const Case& c) {
  const std::vector<std::string> kinds = names_of(c.kinds);
  if (!t.has("particles") && !t.has("mixture") && kinds.size() == 1) t.text("particles", kinds[0]);
  if (t.one_of({"particles", "mixture"}) == "particles") return {{t.index("particles", "particle kind", kinds)}, {1.0}};
  Mixture mixture;
  const auto [names, fractions] = t.weights("mixture");
  const double sum = std::accumulate(fractions.begin(), fractions.end(), 0.0);
  if (std::abs(sum - 1) > 1e-3)
    t.fail("mixture", fmt::format("the mass fractions {} sum to {:.6g}, must be 1", t.shown("mixture"), sum));
  for (size_t i = 0; i < names.size(); ++i) {
    mixture.kinds.push_back(t.index_of("mixture", names[i], "particle kind", kinds));
    mixture.mass_fractions.push_back(fractions[i] / sum);
  }
  return mixture;
}

void check_fits(const TableReader& t, const std::string& key, const Case& c, const Mixture& mixture, uint32_t region) {
  const Bounds b = bounds_of(c.regions[region]);
  const double least = std::min({b.max.x - b.min.x, b.max.y - b.min.y, b.max.z - b.min.z});
  for (const uint32_t kind : mixture.kinds) {
    const double largest = largest_diameter(c.kinds[kind].size);
    if (largest <= least) continue;
    t.fail(key,
           fmt::format("region '{}' is {:.4g} m wide, too narrow for particles '{}' of {:.4g} m; are all lengths in m?",
                       c.regions[region].name, least, c.kinds[kind].name, largest));
  }
}

bool boxes_overlap(const Region& a, const Region& b) {
  if (a.shape != Region::Shape::box || b.shape != Region::Shape::box) return false;
  const auto apart = [](double a0, double a1, double b0, double b1) { return a1 <= b0 || b1 <= a0; };
  return !apart(a.min.x, a.max.x, b.min.x, b.max.x) && !apart(a.min.y, a.max.y, b.min.y, b.max.y) &&
         !apart(a.min.z, a.max.z, b.min.z, b.max.z);
}

void claim_region(const TableReader& t, const std::string& key, const Case& c, uint32_t region, Progress& progress) {
  for (const uint32_t other : progress.filled) {
    if (other != region && !boxes_overlap(c.regions[other], c.regions[region])) continue;
    t.fail(key,
           fmt::format("region '{}'{} is filled already and no time passes between: put a settle or drain stage before "
                       "this one, or choose another region",
                       c.regions[region].name,
                       other == region ? "" : fmt::format(" overlaps region '{}', which", c.regions[other].name)));
  }
  progress.filled.push_back(region);
}

// Mass or count; at most one.
void read_amount(TableReader& t, double& mass, uint64_t& count) {
  const std::string given = t.at_most_one_of({"mass", "count"});
  if (given == "mass") mass = t.number("mass", kMass);
  if (given == "count") count = t.whole("count", kCount);
}

double solid_volume(const Case& c, const FillStage& fill) {
  double volume = 0;
  for (size_t i = 0; i < fill.mixture.kinds.size(); ++i) {
    const ParticleKind& kind = c.kinds[fill.mixture.kinds[i]];
    const double density = c.materials[kind.material].density;
    volume += fill.mixture.mass_fractions[i] / density;  // of 1 kg
  }
  return volume * (fill.count > 0 ? static_cast<double>(fill.count) / particles_per_mass(c, fill.mixture) : fill.mass);
}

void check_capacity(const TableReader& t, const Case& c, const FillStage& fill) {
  double room = 0;
  for (const uint32_t region : fill.regions) room += fill.solid_fraction * volume_of(c.regions[region]);
  const double needed = solid_volume(c, fill);
  if (needed <= room) return;
  t.fail(fill.mass > 0 ? "mass" : "count",
         fmt::format("{} does not fit: the particles have {:.4g} m3, the regions hold at most {:.4g} m3 of them at "
                     "solid_fraction {}",
                     t.shown(fill.mass > 0 ? "mass" : "count"), needed, room, fill.solid_fraction));
}

StageAction read_fill(TableReader& t, const Case& c, Progress& progress) {
  FillStage fill;
  fill.mixture = read_mixture(t, c);
  for (const std::string& name : t.texts("regions")) {
    fill.regions.push_back(t.index_of("regions", name, "region", names_of(c.regions)));
    check_fits(t, "regions", c, fill.mixture, fill.regions.back());
    claim_region(t, "regions", c, fill.regions.back(), progress);
  }
  read_amount(t, fill.mass, fill.count);
  fill.solid_fraction = t.number("solid_fraction", positive(0.6, ""), fill.solid_fraction);
  fill.velocity = t.vec3("velocity", kVelocity, fill.velocity);
  check_capacity(t, c, fill);
  return fill;
}

StageAction read_pour(TableReader& t, const Case& c, Progress& progress) {
  PourStage pour;
  pour.mixture = read_mixture(t, c);
  pour.region = t.index("region", "region", names_of(c.regions));
  check_fits(t, "region", c, pour.mixture, pour.region);
  claim_region(t, "region", c, pour.region, progress);
  progress.filled.clear();  // pouring takes time
  t.one_of({"mass", "count"});
  read_amount(t, pour.mass, pour.count);
  pour.rate = t.number("rate", positive(1e6, "kg/s"));
  pour.solid_fraction = t.number("solid_fraction", positive(0.6, ""), pour.solid_fraction);
  pour.velocity = t.vec3("velocity", kVelocity, pour.velocity);
  return pour;
}

StageAction read_read(TableReader& t, const Case& c) {
  ReadStage read;
  read.file = path_beside(t, "file", t.text("file"));
  t.rewrite("file", read.file);
  const std::vector<std::string> kinds = names_of(c.kinds);
  if (kinds.size() == 1) t.text("particles", kinds[0]);
  read.kind = t.index("particles", "particle kind", kinds);
  return read;
}

void require_particles(const TableReader& t, const Progress& progress) {
  if (!progress.particles)
    t.fail("kind",
           fmt::format("{} before there are particles: put a fill, pour or read stage before it", t.shown("kind")));
}

StageAction read_settle(TableReader& t, Progress& progress) {
  require_particles(t, progress);
  SettleStage settle;
  if (t.one_of({"time", "kinetic_energy_per_particle"}) == "time") {
    settle.max_time = t.number("time", kDuration);
    return settle;
  }
  settle.kinetic_energy_per_particle = t.number("kinetic_energy_per_particle", positive(1e6, "J"));
  settle.max_time = t.number("max_time", kDuration);
  settle.min_time = t.number("min_time", between(0, 1e6, "s"), 0.0);
  if (settle.min_time > settle.max_time)
    t.fail("min_time", fmt::format("{} is longer than max_time = {} s", t.shown("min_time"), t.shown("max_time")));
  return settle;
}

StageAction read_open(TableReader& t, const Case& c, Progress& progress) {
  OpenStage open;
  open.walls = t.texts("walls");
  for (const std::string& wall : open.walls) {
    t.index_of("walls", wall, "wall", c.solid.walls);
    if (std::ranges::find(progress.opened, wall) != progress.opened.end()) {
      t.fail("walls", fmt::format("wall '{}' is open already, an earlier stage opened it", wall));
    }
    progress.opened.push_back(wall);
  }
  return open;
}

StageAction read_drain(TableReader& t, const Case& c, Progress& progress) {
  require_particles(t, progress);
  DrainStage drain;
  if (t.has("max_time")) drain.max_time = t.number("max_time", kDuration);
  if (t.has("discharged_fraction")) drain.discharged_fraction = t.number("discharged_fraction", positive(1, ""));
  if (t.has("no_flow_time")) drain.no_flow_time = t.number("no_flow_time", kDuration);
  if (drain.max_time == 0 && drain.discharged_fraction == 0 && drain.no_flow_time == 0) {
    t.fail("kind", "\"drain\" never ends, give one or more of: max_time (s), discharged_fraction, no_flow_time (s)");
  }
  for (const char* key : {"discharged_fraction", "no_flow_time"}) {
    if (t.has(key) && c.outlets.empty())
      t.fail(key, fmt::format("{} needs an outlet to count at; add [[outlet]]", t.shown(key)));
  }
  return drain;
}

void check_number(const TableReader& t, const Case& c, const StageAction& action, Progress& progress) {
  progress.expected += expected_particles(c, action);
  if (progress.expected <= kMostParticles) return;  // false for a number that is none, too
  const std::string key = t.shown("mass") != "not given" ? "mass" : t.shown("count") != "not given" ? "count" : "kind";
  t.fail(key, fmt::format("{} makes {:.3g} particles in all, must be at most {:g}; are lengths in m and masses in kg?",
                          t.shown(key), progress.expected, kMostParticles));
}

enum class Kind { fill, pour, read, settle, open, drain };

StageAction read_action(Kind kind, TableReader& t, const Case& c, Progress& progress) {
  switch (kind) {
    case Kind::fill:
      return read_fill(t, c, progress);
    case Kind::pour:
      return read_pour(t, c, progress);
    case Kind::read:
      return read_read(t, c);
    case Kind::settle:
      return read_settle(t, progress);
    case Kind::open:
      return read_open(t, c, progress);
    case Kind::drain:
      return read_drain(t, c, progress);
  }
  throw std::logic_error("no such stage");
}

}  // namespace

void read_stages(TableReader& top, Case& c) {
  std::vector<TableReader> tables = top.tables("stage");
  if (tables.empty()) top.one_of({"stage"});
  Progress progress;
  for (TableReader& t : tables) {
    const Kind kind = t.choice<Kind>("kind", {{"fill", Kind::fill},
                                              {"pour", Kind::pour},
                                              {"read", Kind::read},
                                              {"settle", Kind::settle},
                                              {"open", Kind::open},
                                              {"drain", Kind::drain}});
    Stage stage;
    stage.name = t.name("name", t.text("kind"));
    if (std::ranges::any_of(c.stages, [&](const Stage& other) { return other.name == stage.name; })) {
      t.fail("name", fmt::format("there are two stages named '{}', give each its own name", stage.name));
    }
    stage.action = read_action(kind, t, c, progress);
    t.finish();
    progress.particles = progress.particles || kind <= Kind::read;
    if (kind == Kind::settle || kind == Kind::drain) progress.filled.clear();
    check_number(t, c, stage.action, progress);
    c.stages.push_back(std::move(stage));
  }
  if (!progress.particles) tables.back().fail("kind", "no stage brings in particles: add a fill, pour or read stage");
}

}  // namespace scree
