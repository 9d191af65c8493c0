#include "runtime/case_reader.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <set>

#include "kernels/particle.h"
#include "runtime/case_physics.h"
#include "runtime/case_sections.h"
#include "runtime/case_size.h"
#include "runtime/csv_table.h"
#include "runtime/render/run_pictures.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

SizeDistribution one_diameter(double diameter) {
  SizeDistribution size;
  size.diameters = {diameter};
  size.fractions = {1};
  return size;
}

constexpr Range kDiameter{1e-7, 10, "m", false};
constexpr Range kFraction = positive(1, "");
constexpr double kLeastShare = 0.01;  // of a distribution that its limits may leave: diameters are drawn until one fits
constexpr double kMostRows = 1e8;     // of mass_flow.csv
constexpr double kMostOverlap = 0.5;  // as a share: a deeper one could go through a wall between two rebuilds, unseen

void read_list(TableReader& t, SizeDistribution& size) {
  size.diameters = t.numbers("diameters", kDiameter, 0);
  size.fractions = t.numbers("fractions", kFraction, 0);
  size.fractions_by_mass = t.choice<bool>("by", {{"mass", true}, {"number", false}}, "mass");
  if (size.fractions.size() != size.diameters.size()) {
    t.fail("fractions", fmt::format("{} has {} entries, must be {} like diameters", t.shown("fractions"),
                                    size.fractions.size(), size.diameters.size()));
  }
  const double sum = std::accumulate(size.fractions.begin(), size.fractions.end(), 0.0);
  if (std::abs(sum - 1) > 1e-3)
    t.fail("fractions", fmt::format("{} sums to {:.6g}, must be 1", t.shown("fractions"), sum));
  for (double& fraction : size.fractions) fraction /= sum;
}

void read_truncated(TableReader& t, SizeDistribution& size) {
  const bool normal = size.kind == SizeDistribution::Kind::normal;
  const char* middle = normal ? "mean" : "median";
  size.mean = t.number(middle, kDiameter);
  size.deviation = t.number("deviation", normal ? positive(10, "m") : positive(3, "(standard deviation of ln d)"));
  size.min = t.number("min", kDiameter);
  size.max = t.number("max", kDiameter);
  if (size.max < size.min)
    t.fail("max", fmt::format("{} is below min = {}, must be at least min", t.shown("max"), t.shown("min")));
  if (size.mean < size.min || size.mean > size.max) {
    t.fail(middle, fmt::format("{} is cut off, must be between min = {} and max = {} m", t.shown(middle),
                               t.shown("min"), t.shown("max")));
  }
  if (const double share = share_between_limits(size); !(share >= kLeastShare)) {
    t.fail("deviation", fmt::format("{} leaves {:.2g} of the distribution between min = {} and max = {}, must be at "
                                    "least {:g}: a smaller deviation, wider limits, or one diameter",
                                    t.shown("deviation"), share, t.shown("min"), t.shown("max"), kLeastShare));
  }
}

SizeDistribution read_distribution(TableReader t) {
  using Kind = SizeDistribution::Kind;
  SizeDistribution size;
  size.kind = t.choice<Kind>("kind", {{"list", Kind::list}, {"normal", Kind::normal}, {"lognormal", Kind::lognormal}});
  size.kind == Kind::list ? read_list(t, size) : read_truncated(t, size);
  t.finish();
  return size;
}

void read_output(TableReader t, OutputSettings& output) {
  output.interval = t.number("interval", kDuration, output.interval);
  output.final_vtk = t.flag("final_vtk", output.final_vtk);
  output.energy_ledger = t.flag("energy_ledger", output.energy_ledger);
  if (t.has("steady_window")) {
    const std::vector<double> window = t.numbers("steady_window", between(0, 1e6, "s"), 2);
    if (window[1] <= window[0])
      t.fail("steady_window",
             fmt::format("{} ends before it begins, must be [from, to] with from < to, s", t.shown("steady_window")));
    output.steady_from = window[0];
    output.steady_to = window[1];
  }
  read_pictures(t, output.pictures);
  for (const char* later : {"fields", "residence", "default_average", "average", "touch"})
    t.has(later);  // read_observers(), when the rest is known
  t.finish();
}

void read_checkpoint(TableReader t, CheckpointSettings& checkpoint) {
  checkpoint.interval = t.number("interval", positive(1e9, "s (wall-clock)"), checkpoint.interval);
  checkpoint.keep = t.whole("keep", between(0, 1000, "checkpoints (0: none is written)"), checkpoint.keep);
  t.finish();
}

// What a material belongs to, for the message about a missing pair.
struct Touching {
  uint32_t first, second;
  std::string who;
};

// Every kind touches every kind (itself, too) and every wall.
std::vector<Touching> touching_materials(const Case& c) {
  std::vector<Touching> result;
  std::set<std::pair<uint32_t, uint32_t>> surfaces;  // (material, wall); a lattice's fibres are all alike
  for (const Primitive& p : c.solid.primitives) surfaces.insert({p.material, p.wall});
  for (size_t i = 0; i < c.kinds.size(); ++i) {
    for (size_t j = i; j < c.kinds.size(); ++j) {
      result.push_back({c.kinds[i].material, c.kinds[j].material,
                        fmt::format("particles '{}' and '{}'", c.kinds[i].name, c.kinds[j].name)});
    }
    for (const auto& [material, wall] : surfaces) {
      result.push_back({c.kinds[i].material, material,
                        fmt::format("particles '{}' and wall '{}'", c.kinds[i].name, c.solid.walls[wall])});
    }
  }
  return result;
}

bool is_pair(const MaterialPair& pair, uint32_t a, uint32_t b) {
  return (pair.first == a && pair.second == b) || (pair.first == b && pair.second == a);
}

bool has_pair(const Case& c, uint32_t a, uint32_t b) {
  return std::ranges::any_of(c.pairs, [&](const MaterialPair& pair) { return is_pair(pair, a, b); });
}

void check_pairs_complete(TableReader& top, const Case& c) {
  std::vector<std::vector<bool>> checked(c.materials.size(), std::vector<bool>(c.materials.size()));
  for (const Touching& touching : touching_materials(c)) {
    if (checked[touching.first][touching.second]) continue;
    checked[touching.first][touching.second] = true;
    if (has_pair(c, touching.first, touching.second)) continue;
    const std::string &a = c.materials[touching.first].name, &b = c.materials[touching.second].name;
    top.fail("pair", fmt::format("the pair of materials '{}' and '{}' is missing, but {} can touch; add [[pair]] "
                                 "materials = [\"{}\", \"{}\"]",
                                 a, b, touching.who, a, b));
  }
}

}  // namespace

std::string new_name(TableReader& table, const std::string& what, const std::vector<std::string>& names) {
  const std::string name = table.name();
  if (std::ranges::find(names, name) != names.end()) {
    table.fail("name", fmt::format("there are two {}s named '{}', names must differ", what, name));
  }
  return name;
}

std::string path_beside(const TableReader& table, const std::string& key, const std::string& file) {
  const SourcePlace place = table.place(key);
  const fs::path folder =
      place.line > 0 ? fs::path(place.file).parent_path() : fs::path();  // an override: the working folder
  std::error_code error;
  const fs::path path = fs::absolute(folder / file, error).lexically_normal();
  if (!fs::is_regular_file(path, error)) table.fail(key, fmt::format("the file \"{}\" does not exist", path.string()));
  require_room_for_csv(table.place(key), path.string());
  return path.string();
}

void read_settings(TableReader& top, Case& c) {
  c.title = top.text("title", "untitled");
  c.seed = top.whole("seed", between(0, 9.2e18, ""), uint64_t{1});
  c.gravity = top.vec3("gravity", between(-1e3, 1e3, "m/s2"), c.gravity);
  TableReader contact = top.table("contact");
  c.contact.model =
      contact.choice<ContactModel>("law", {{"hertz_mindlin", ContactModel::hertz_mindlin}}, "hertz_mindlin");
  c.contact.rolling = contact.choice<RollingModel>(
      "rolling", {{"none", RollingModel::none}, {"cdt", RollingModel::cdt}, {"epsd2", RollingModel::epsd2}}, "epsd2");
  c.contact.limit_attraction = contact.flag("limit_attraction", false);
  c.contact.precision = contact.choice<Precision>(
      "precision", {{"mixed", Precision::mixed}, {"reference", Precision::reference}}, "mixed");
  contact.finish();
  TableReader neighbour = top.table("neighbour");
  c.neighbour.skin = neighbour.number("skin", between(0, 1, "m (0: chosen by the program)"), 0);
  neighbour.finish();
  TableReader watch = top.table("watch");
  c.watch.max_overlap = watch.number("max_overlap", positive(kMostOverlap, "of the radii' sum, at walls of the radius"),
                                     c.watch.max_overlap);
  watch.finish();
  read_output(top.table("output"), c.output);
  read_checkpoint(top.table("checkpoint"), c.checkpoint);
}

void read_materials(TableReader& top, Case& c) {
  for (TableReader& t : top.tables("material")) {
    Material m;
    m.name = new_name(t, "material", names_of(c.materials));
    if (t.has("density")) m.density = t.number("density", between(10, 1e5, "kg/m3"));
    m.youngs_modulus = t.number("youngs_modulus", between(1e3, 1e13, "Pa"));
    m.poisson_ratio = t.number("poisson_ratio", {-1, 0.5, "", true});
    t.finish();
    c.materials.push_back(m);
  }
}

void read_particles(TableReader& top, Case& c) {
  std::vector<TableReader> tables = top.tables("particles");
  if (tables.empty()) top.one_of({"particles"});
  if (tables.size() > kMaxKinds)
    top.fail("particles", fmt::format("{} kinds of particles, must be at most {}", tables.size(), kMaxKinds));
  for (TableReader& t : tables) {
    ParticleKind kind;
    kind.name = new_name(t, "particle kind", names_of(c.kinds));
    kind.material = t.index("material", "material", names_of(c.materials));
    if (c.materials[kind.material].density == 0) {
      t.fail("material",
             fmt::format("material {} has no density, which particles need (10 to 1e5 kg/m3)", t.shown("material")));
    }
    const bool one = t.one_of({"diameter", "distribution"}) == "diameter";
    kind.size = one ? one_diameter(t.number("diameter", kDiameter)) : read_distribution(t.table("distribution"));
    t.finish();
    c.kinds.push_back(kind);
  }
}

void read_pairs(TableReader& top, Case& c) {
  for (TableReader& t : top.tables("pair")) {
    const std::vector<std::string> materials = t.pair_of_texts("materials");
    MaterialPair pair;
    pair.first = t.index_of("materials", materials[0], "material", names_of(c.materials));
    pair.second = t.index_of("materials", materials[1], "material", names_of(c.materials));
    if (has_pair(c, pair.first, pair.second)) {
      t.fail("materials", fmt::format("the pair {} is given twice", t.shown("materials")));
    }
    pair.restitution = t.number("restitution", between(0, 1, ""));
    pair.sliding_friction = t.number("sliding_friction", between(0, 10, ""));
    pair.rolling_friction = c.contact.rolling == RollingModel::none
                                ? t.number("rolling_friction", between(0, 10, ""), 0)
                                : t.number("rolling_friction", between(0, 10, ""));
    t.finish();
    c.pairs.push_back(pair);
  }
  check_pairs_complete(top, c);
}

void read_time(TableReader& top, Case& c) {
  TableReader t = top.table("time");
  const double rayleigh = smallest_rayleigh_time(c);
  c.time.allow_large_step = t.flag("allow_large_step", false);
  const double limit = c.time.allow_large_step ? 10 : 0.5;
  if (t.at_most_one_of({"step", "rayleigh_fraction"}) != "step") {
    c.time.rayleigh_fraction =
        t.number("rayleigh_fraction", between(1e-4, limit, "Rayleigh times"), c.time.rayleigh_fraction);
  } else {
    c.time.step = t.number("step", between(1e-15, 1, "s"));
    if (c.time.step > limit * rayleigh) {
      t.fail("step", fmt::format("{} s is {:.3g} of the smallest Rayleigh time, must be at most {} of it ({:.4g} s); "
                                 "allow_large_step = true allows more",
                                 t.shown("step"), c.time.step / rayleigh, limit, limit * rayleigh));
    }
  }
  t.finish();
}

namespace {

// A row for every interval of the longest run, all of them kept for the steady flow.
void check_rows(TableReader top, const Case& c) {
  const double rows = longest_time(c) / c.output.interval;
  if (rows <= kMostRows) return;
  TableReader output = top.table("output");
  output.fail("interval",
              fmt::format("{} s makes {:.3g} rows of mass_flow.csv in the stages' {:.4g} s, must be at most "
                          "{:g}",
                          output.shown("interval"), rows, longest_time(c), kMostRows));
}

Case case_from(CaseNode tree, const std::string& path) {
  TableReader top(tree, "");
  Case c;
  c.source = path;
  read_settings(top, c);
  read_materials(top, c);
  read_particles(top, c);
  read_regions(top, c);
  read_outlets(top, c);
  read_meters(top, c);
  read_solid(top, c);
  read_pairs(top, c);
  read_time(top, c);
  read_stages(top, c);
  read_observers(top, c);
  check_rows(top, c);
  top.finish();
  c.understood = emit_toml(tree);
  return c;
}

}  // namespace

Case read_case(const std::string& path, const std::vector<std::string>& overrides) {
  return case_from(load_case_tree(path, overrides), path);
}

Case read_case_text(const std::string& text, const std::string& path, const std::vector<std::string>& overrides) {
  return case_from(load_case_tree(text, path, overrides), path);
}

}  // namespace scree
