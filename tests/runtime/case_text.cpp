#include "tests/runtime/case_text.h"

#include <fmt/format.h>

namespace scree::testing {
namespace {

struct Text {
  std::string out;

  void add(double v) { out += fmt::format("{} ", v); }  // the shortest that reads back to the same bits
  void add(const Vec3& v) { add(v.x), add(v.y), add(v.z); }
  void add(const std::string& s) { out += s + ' '; }
  void add(const Bounds& b) { add(b.min), add(b.max); }
  template <class T>
  void add(const std::vector<T>& values) {
    out += '[';
    for (const T& value : values) add(value);
    out += "] ";
  }
  template <class E>
  requires std::is_enum_v<E>
  void add(E value) { add(static_cast<double>(value)); }
  template <class T>
  requires std::is_integral_v<T>
  void add(T value) { out += fmt::format("{} ", value); }
  template <class... T>
  void row(const char* name, const T&... values) {
    out += fmt::format("{}: ", name);
    (add(values), ...);
    out += '\n';
  }

  void add(const Mixture& m) { add(m.kinds), add(m.mass_fractions); }
  void operator()(const Segment& s) { row("segment", s.a, s.b); }
  void operator()(const Quad& q) { row("quad", q.corners[0], q.corners[1], q.corners[2], q.corners[3]); }
  void operator()(const Revolution& r) { row("revolution", r.base, r.axis, r.r0, r.h0, r.r1, r.h1); }
  void operator()(const FillStage& s) {
    row("fill", s.regions, s.mixture, s.mass, s.count, s.solid_fraction, s.velocity);
  }
  void operator()(const PourStage& s) {
    row("pour", s.region, s.mixture, s.rate, s.mass, s.count, s.velocity, s.solid_fraction);
  }
  void operator()(const ReadStage& s) { row("read", s.file, s.kind); }
  void operator()(const SettleStage& s) { row("settle", s.max_time, s.kinetic_energy_per_particle, s.min_time); }
  void operator()(const OpenStage& s) { row("open", s.walls); }
  void operator()(const DrainStage& s) { row("drain", s.max_time, s.discharged_fraction, s.no_flow_time); }
};

void describe_settings(const Case& c, Text& t) {
  t.row("case", c.title, c.seed, c.gravity, c.domain, c.periodic[0], c.periodic[1], c.periodic[2]);
  t.row("contact", c.contact.model, c.contact.rolling, c.contact.limit_attraction, c.contact.precision);
  t.row("time", c.time.step, c.time.rayleigh_fraction, c.time.allow_large_step, c.neighbour.skin, c.watch.max_overlap);
  t.row("checkpoint", c.checkpoint.interval, c.checkpoint.keep);
  t.row("output", c.output.interval, c.output.steady_from, c.output.steady_to, c.output.final_vtk,
        c.output.energy_ledger);
  for (const AverageSettings& a : c.output.averages)
    t.row("average", a.name, a.box, a.spacing, a.width, a.during, a.moments.interval, a.moments.times,
          a.moments.stage_ends, a.moments.from, a.moments.to);
  const TouchSettings& touch = c.output.touch;
  t.row("touch", touch.enabled, touch.cell, touch.around, touch.walls, touch.during, touch.moments.interval,
        touch.moments.times, touch.moments.stage_ends, touch.moments.from, touch.moments.to);
  const FieldSettings& f = c.output.fields;
  t.row("fields", f.moments.interval, f.moments.times, f.moments.stage_ends, f.moments.from, f.moments.to, f.write,
        f.solid);
  const ResidenceSettings& r = c.output.residence;
  t.row("residence", r.enabled, r.interval, r.entry, r.exit, r.bin);
}

void describe_matter(const Case& c, Text& t) {
  for (const Material& m : c.materials) t.row("material", m.name, m.density, m.youngs_modulus, m.poisson_ratio);
  for (const MaterialPair& p : c.pairs)
    t.row("pair", p.first, p.second, p.restitution, p.sliding_friction, p.rolling_friction);
  for (const ParticleKind& k : c.kinds) {
    t.row("kind", k.name, k.material, k.size.kind, k.size.diameters, k.size.fractions, k.size.fractions_by_mass,
          k.size.mean, k.size.deviation, k.size.min, k.size.max);
  }
}

void describe_space(const Case& c, Text& t) {
  t.row("walls", c.solid.walls);
  for (const Primitive& p : c.solid.primitives) {
    t.row("primitive", p.radius, p.material, p.wall, p.velocity);
    std::visit(t, p.skeleton);
  }
  t.row("fibres", c.fibres.diameter, c.fibres.porosity, c.fibres.volume, c.fibres.count, c.fibres.section);
  for (const Region& r : c.regions) {
    t.row("region", r.name, r.shape, r.min, r.max, r.base, r.axis, r.radius, r.height, r.bottom_x, r.bottom_y, r.top_x,
          r.top_y);
  }
  for (const Outlet& o : c.outlets) t.row("outlet", o.name, o.point, o.direction, o.remove_beyond);
  for (const Meter& m : c.meters) t.row("meter", m.name, m.kind, m.min, m.max);
}

}  // namespace

std::string describe(const Case& c) {
  Text t;
  describe_settings(c, t);
  describe_matter(c, t);
  describe_space(c, t);
  for (const Stage& s : c.stages) {
    t.row("stage", s.name);
    std::visit(t, s.action);
  }
  return t.out;
}

const char* const kGoodCase = R"(title = "good"
seed = 7
gravity = [0, 0, -9.81]

[contact]
rolling = "epsd2"

[time]
step = 5e-6

[output]
interval = 1e-3

[[material]]
name = "bead"
density = 3071
youngs_modulus = 1e7
poisson_ratio = 0.28

[[material]]
name = "steel"
youngs_modulus = 1e7
poisson_ratio = 0.3

[[pair]]
materials = ["bead", "bead"]
restitution = 0.52
sliding_friction = 0.53
rolling_friction = 0.37

[[pair]]
materials = ["bead", "steel"]
restitution = 0.41
sliding_friction = 0.5
rolling_friction = 0.41

[[particles]]
name = "grain"
material = "bead"
diameter = 400e-6

[lattice]
material = "steel"
cell_size = 10e-3
cells = [1, 1, 2]
origin = [-5e-3, -5e-3, 0]
fibre_diameter = 1.0e-3

[[wall]]
name = "hopper"
material = "steel"
kind = "frustum"
centre = [0, 0]
bottom = [10e-3, 10e-3]
top = [20e-3, 20e-3]
z = [20e-3, 44e-3]

[[wall]]
name = "lid"
material = "steel"
kind = "rectangle"
min = [-5e-3, -5e-3, 20e-3]
max = [5e-3, 5e-3, 20e-3]

[[region]]
name = "inside"
shape = "box"
min = [-4e-3, -4e-3, 21e-3]
max = [4e-3, 4e-3, 40e-3]

[[outlet]]
name = "exit"
point = [0, 0, 0]

[[meter]]
name = "lattice"
min = [-5e-3, -5e-3, 0]
max = [5e-3, 5e-3, 20e-3]

[[stage]]
kind = "fill"
regions = ["inside"]
mass = 1e-3

[[stage]]
kind = "settle"
time = 0.1

[[stage]]
kind = "open"
walls = ["lid"]

[[stage]]
kind = "drain"
discharged_fraction = 0.5
)";

}  // namespace scree::testing
