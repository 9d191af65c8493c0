// [lattice], [[fibres]] and [[wall]]: what particles touch.
#include <algorithm>
#include <stdexcept>

#include "geometry/bounds.h"
#include "geometry/closest_point.h"
#include "geometry/octet_lattice.h"
#include "geometry/porosity.h"
#include "geometry/walls.h"
#include "runtime/case_sections.h"
#include "runtime/csv_fibres.h"
#include "runtime/memory.h"

namespace scree {
namespace {

constexpr double kFibresPerCell = 25;  // of an Octet lattice, about: a cell's own and its share of its neighbours'

// What a generator of geometry/ refuses becomes an error of the table that described it.
template <class Make>
auto generated(const TableReader& t, const std::string& key, const Make& make) {
  try {
    return make();
  } catch (const std::invalid_argument& error) {
    t.fail(key, error.what());
  }
}

// Enters a wall by its name; its material stands beside it.
SurfaceLabel new_wall(TableReader& t, Case& c, const char* default_name) {
  const std::string name = default_name ? t.name("name", default_name) : t.name("name");
  if (std::ranges::find(c.solid.walls, name) != c.solid.walls.end()) {
    t.fail("name", fmt::format("there are two walls named '{}' (fibres count as walls), names must differ", name));
  }
  c.solid.walls.push_back(name);
  return {t.index("material", "material", names_of(c.materials)), static_cast<uint32_t>(c.solid.walls.size() - 1)};
}

// A primitive that the engine could not prepare is an error of the table now, not of the run later.
void add(const TableReader& t, const std::string& key, Case& c, const Primitives& primitives) {
  for (const Primitive& p : primitives) generated(t, key, [&] { return prepared(p); });
  c.solid.primitives.insert(c.solid.primitives.end(), primitives.begin(), primitives.end());
}

void read_lattice(TableReader t, Case& c) {
  t.choice<int>("kind", {{"octet", 0}}, "octet");
  const SurfaceLabel label = new_wall(t, c, "lattice");
  const double cell_size = t.number("cell_size", between(1e-7, 10, "m"));
  const std::vector<double> cells = t.whole_numbers("cells", between(1, 1e4, "cells"), 3);
  const Vec3 origin = t.vec3("origin", kPosition);
  const double fibres = kFibresPerCell * cells[0] * cells[1] * cells[2];
  require_memory(t.place("cells"), fmt::format("key 'lattice.cells': the lattice's {:.3g} fibres need", fibres),
                 memory_of_primitives(fibres));
  const OctetLattice lattice = generated(t, "cells", [&] {
    return octet_lattice(cell_size, {int(cells[0]), int(cells[1]), int(cells[2])}, origin);
  });
  if (t.one_of({"fibre_diameter", "porosity"}) == "fibre_diameter") {
    c.fibres.diameter = t.number("fibre_diameter", kFibreDiameter);
    if (c.fibres.diameter >= cell_size) {
      t.fail("fibre_diameter",
             fmt::format("{} m must be less than cell_size = {} m", t.shown("fibre_diameter"), cell_size));
    }
  } else {
    const double target = t.number("porosity", {0, 0.9999, "", true});
    c.fibres.diameter = generated(t, "porosity", [&] { return fibre_diameter_for_porosity(lattice, target); });
    t.comment("porosity", fmt::format("fibre_diameter {:.6g} m was solved for", c.fibres.diameter));
  }
  t.finish();
  c.fibres.count = lattice.fibres.size();
  c.fibres.section = section_of(lattice);
  c.fibres.porosity = porosity(lattice, c.fibres.diameter);
  c.fibres.volume = (1 - c.fibres.porosity) * volume_of(c.fibres.section);
  add(t, "fibre_diameter", c,
      generated(t, "fibre_diameter", [&] { return fibre_primitives(lattice, c.fibres.diameter, label); }));
}

std::vector<Fibre> read_segments(TableReader& t) {
  std::vector<Fibre> fibres;
  for (const auto& v : t.rows("segments", kPosition, 6)) {
    fibres.push_back({{{v[0], v[1], v[2]}, {v[3], v[4], v[5]}}, 0});
    if (norm(fibres.back().axis.b - fibres.back().axis.a) >= kShortestFibre) continue;
    t.fail("segments", fmt::format("segment {} from [{}, {}, {}] has no length, its ends must be {:g} m apart",
                                   fibres.size(), v[0], v[1], v[2], kShortestFibre));
  }
  return fibres;
}

void read_fibres(TableReader& t, Case& c) {
  const SurfaceLabel label = new_wall(t, c, nullptr);
  std::vector<Fibre> fibres;
  if (t.one_of({"segments", "file"}) == "segments") {
    fibres = read_segments(t);
  } else {
    const std::string file = path_beside(t, "file", t.text("file"));
    t.rewrite("file", file);
    fibres = read_fibres_csv(file);
  }
  const bool all_given = std::ranges::all_of(fibres, [](const Fibre& fibre) { return fibre.diameter > 0; });
  if (all_given && t.has("diameter"))
    t.fail("diameter",
           fmt::format("{} contradicts the column 'diameter' of the file, give one of them", t.shown("diameter")));
  const double diameter = all_given ? 0 : t.number("diameter", kFibreDiameter);
  t.finish();
  for (const Fibre& fibre : fibres) {
    add(t, "diameter", c, generated(t, "diameter", [&] {
          return fibre_network(std::span(&fibre.axis, 1), fibre.diameter > 0 ? fibre.diameter : diameter, label);
        }));
  }
}

// What [[fibres]] made: one diameter or none in common; the porosity of the union, if it can be said for all of them.
void measure_network(Case& c) {
  std::vector<Segment> axes;
  Bounds box = empty_bounds();
  double diameter = 0;
  bool same = true;
  for (const Primitive& p : c.solid.primitives) {
    const auto* axis = std::get_if<Segment>(&p.skeleton);
    if (!axis) continue;
    same = same && (axes.empty() || 2 * p.radius == diameter);
    diameter = 2 * p.radius;
    axes.push_back(*axis);
    box = united(box, bounds_of(Primitive{*axis}));
  }
  if (c.fibres.count == axes.size()) return;  // the lattice's alone, or none
  const bool lattice = c.fibres.count > 0;
  c.fibres.count = axes.size();
  c.fibres.diameter = same ? diameter : 0;
  c.fibres.section = lattice ? c.fibres.section : box;
  const bool measurable = same && volume_of(c.fibres.section) > 0;
  c.fibres.porosity = measurable ? porosity(axes, diameter, c.fibres.section) : 0;
  c.fibres.volume = measurable ? (1 - c.fibres.porosity) * volume_of(c.fibres.section) : 0;
}

Bounds box_of(TableReader& t) {
  const Bounds box{t.vec3("min", kPosition), t.vec3("max", kPosition)};
  if (box.min.x < box.max.x && box.min.y < box.max.y && box.min.z < box.max.z) return box;
  t.fail("max",
         fmt::format("{} is not above min = {}, must be greater in x, y and z, m", t.shown("max"), t.shown("min")));
}

Primitives read_quad(TableReader& t, const SurfaceLabel& label) {
  std::vector<std::vector<double>> rows = t.rows("corners", kPosition, 3);
  if (rows.size() != 3 && rows.size() != 4) {
    t.fail("corners", fmt::format("{} corners, must be 4 in order (or 3 for a triangle)", rows.size()));
  }
  if (rows.size() == 3) rows.push_back(rows.back());
  std::array<Vec3, 4> corners;
  for (size_t i = 0; i < 4; ++i) corners[i] = {rows[i][0], rows[i][1], rows[i][2]};
  return generated(t, "corners", [&] { return quad(corners, label); });
}

// Flat along one axis.
Primitives read_rectangle(TableReader& t, const SurfaceLabel& label) {
  const Vec3 min = t.vec3("min", kPosition), max = t.vec3("max", kPosition), d = max - min;
  const int flat = (d.x == 0) + (d.y == 0) + (d.z == 0);
  if (flat != 1 || d.x < 0 || d.y < 0 || d.z < 0) {
    t.fail("max", fmt::format("{} with min = {} is no rectangle: they must be equal along one axis and max greater "
                              "along the other two, m",
                              t.shown("max"), t.shown("min")));
  }
  return generated(t, "max", [&] {
    if (d.x == 0) return rectangle(min, {0, d.y, 0}, {0, 0, d.z}, label);
    if (d.y == 0) return rectangle(min, {d.x, 0, 0}, {0, 0, d.z}, label);
    return rectangle(min, {d.x, 0, 0}, {0, d.y, 0}, label);
  });
}

Primitives read_box_wall(TableReader& t, const SurfaceLabel& label) {
  const Bounds box = box_of(t);
  const std::vector<std::string> names = {"left", "right", "front", "back", "bottom", "top"};
  BoxFaces faces;
  bool* face[] = {&faces.x_min, &faces.x_max, &faces.y_min, &faces.y_max, &faces.z_min, &faces.z_max};
  const std::vector<std::string> open = t.texts("open_faces", {});
  for (const std::string& name : open) *face[t.index_of("open_faces", name, "face", names)] = false;
  if (open.size() == names.size()) t.fail("open_faces", "all six faces are open, nothing is left of the box");
  return generated(t, "max", [&] { return box_walls(box, faces, label); });
}

Primitives read_channel(TableReader& t, const SurfaceLabel& label) {
  const Bounds box = box_of(t);
  return generated(t, "max", [&] { return channel(box, label); });
}

Primitives read_frustum_wall(TableReader& t, const SurfaceLabel& label) {
  const auto centre = t.numbers("centre", kPosition, 2), bottom = t.numbers("bottom", kLength, 2);
  const auto top = t.numbers("top", kLength, 2), z = t.numbers("z", kPosition, 2);
  if (z[1] <= z[0]) t.fail("z", fmt::format("{} must be [bottom, top] with bottom < top, m", t.shown("z")));
  return generated(t, "z", [&] {
    return frustum({centre[0], centre[1], z[0], bottom[0], bottom[1], z[1], top[0], top[1]}, label);
  });
}

Primitives read_cylinder_wall(TableReader& t, const SurfaceLabel& label) {
  const Vec3 base = t.vec3("base", kPosition), axis = t.direction("axis", {0, 0, 1});
  const double radius = t.number("radius", kLength), height = t.number("height", kLength);
  return generated(t, "radius", [&] { return cylinder(base, axis, radius, height, label); });
}

Primitives read_cone(TableReader& t, const SurfaceLabel& label) {
  const Range radius = between(0, 1e3, "m");
  Cone shape{t.vec3("base", kPosition), t.direction("axis", {0, 0, 1}), t.number("bottom_radius", radius),
             t.number("top_radius", radius), t.number("height", kLength)};
  return generated(t, "bottom_radius", [&] { return cone(shape, label); });
}

Primitives read_disc(TableReader& t, const SurfaceLabel& label) {
  const Vec3 centre = t.vec3("centre", kPosition), normal = t.direction("normal", {0, 0, 1});
  const double radius = t.number("radius", kLength);
  return generated(t, "radius", [&] { return disc(centre, normal, radius, label); });
}

Primitives read_annulus(TableReader& t, const SurfaceLabel& label) {
  const Vec3 centre = t.vec3("centre", kPosition), normal = t.direction("normal", {0, 0, 1});
  const double inner = t.number("inner_radius", kLength), outer = t.number("outer_radius", kLength);
  if (outer <= inner)
    t.fail("outer_radius", fmt::format("{} m must be greater than inner_radius = {} m", t.shown("outer_radius"),
                                       t.shown("inner_radius")));
  return generated(t, "outer_radius", [&] { return annulus(centre, normal, inner, outer, label); });
}

// A plane ends where the domain ends, so it is made when the domain is known.
struct PendingPlane {
  TableReader table;
  Vec3 point, normal, velocity;
  SurfaceLabel label;
};

using ReadWall = Primitives (*)(TableReader&, const SurfaceLabel&);
const Choices<ReadWall> kWallKinds = {
    {"plane", nullptr},
    {"quad", read_quad},
    {"rectangle", read_rectangle},
    {"box", read_box_wall},
    {"channel", read_channel},
    {"frustum", read_frustum_wall},
    {"cylinder", read_cylinder_wall},
    {"cone", read_cone},
    {"disc", read_disc},
    {"annulus", read_annulus},
};

void read_wall(TableReader& t, Case& c, std::vector<PendingPlane>& planes) {
  const SurfaceLabel label = new_wall(t, c, nullptr);
  const ReadWall read = t.choice<ReadWall>("kind", kWallKinds);
  const Vec3 velocity = t.vec3("velocity", kVelocity, {0, 0, 0});
  if (read) {
    Primitives primitives = read(t, label);
    for (Primitive& p : primitives) p.velocity = velocity;
    add(t, "kind", c, primitives);
  } else {
    planes.push_back({t, t.vec3("point", kPosition), t.direction("normal"), velocity, label});
  }
  t.finish();
}

void add_plane(const PendingPlane& pending, Case& c) {
  Primitives primitives =
      generated(pending.table, "point", [&] { return plane(pending.point, pending.normal, c.domain, pending.label); });
  for (Primitive& p : primitives) p.velocity = pending.velocity;
  add(pending.table, "point", c, primitives);
}

}  // namespace

void read_solid(TableReader& top, Case& c) {
  std::vector<PendingPlane> planes;
  if (top.has("lattice")) read_lattice(top.table("lattice"), c);
  for (TableReader& t : top.tables("fibres")) read_fibres(t, c);
  measure_network(c);
  for (TableReader& t : top.tables("wall")) read_wall(t, c, planes);
  read_domain(top, c, bounds_of(c.solid));
  for (const PendingPlane& plane : planes) add_plane(plane, c);
}

}  // namespace scree
