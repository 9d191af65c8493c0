// [[region]], [[outlet]], [[meter]] and [domain].
#include <algorithm>
#include <cmath>

#include "geometry/bounds.h"
#include "runtime/case_sections.h"
#include "runtime/case_size.h"

namespace scree {
namespace {

constexpr const char* kAxes[] = {"x", "y", "z"};

double along(const Vec3& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

std::string text_of(const Vec3& v) { return fmt::format("[{:.6g}, {:.6g}, {:.6g}]", v.x, v.y, v.z); }

// Reads the corners `min` and `max` and refuses a box without volume.
Bounds read_box(TableReader& t) {
  const Bounds box{t.vec3("min", kPosition), t.vec3("max", kPosition)};
  for (int axis = 0; axis < 3; ++axis) {
    if (along(box.max, axis) > along(box.min, axis)) continue;
    t.fail("max", fmt::format("{} is not above min = {} along {}, must be greater in x, y and z, m", t.shown("max"),
                              t.shown("min"), kAxes[axis]));
  }
  return box;
}

void read_cylinder(TableReader& t, Region& region) {
  region.base = t.vec3("base", kPosition);
  region.axis = t.direction("axis", {0, 0, 1});
  region.radius = t.number("radius", kLength);
  region.height = t.number("height", kLength);
}

void read_frustum(TableReader& t, Region& region) {
  const auto centre = t.numbers("centre", kPosition, 2), bottom = t.numbers("bottom", kLength, 2);
  const auto top = t.numbers("top", kLength, 2), z = t.numbers("z", kPosition, 2);
  if (z[1] <= z[0]) t.fail("z", fmt::format("{} must be [bottom, top] with bottom < top, m", t.shown("z")));
  region.base = {centre[0], centre[1], z[0]};
  region.height = z[1] - z[0];
  region.bottom_x = bottom[0];
  region.bottom_y = bottom[1];
  region.top_x = top[0];
  region.top_y = top[1];
}

Bounds bounds_of_things(const Case& c, const Bounds& solid) {
  Bounds bounds = solid;
  for (const Region& region : c.regions) bounds = united(bounds, bounds_of(region));
  for (const Outlet& outlet : c.outlets) {
    const Vec3 removed = outlet.point + outlet.remove_beyond * outlet.direction;
    bounds = united(bounds, {outlet.point, outlet.point});
    bounds = united(bounds, {removed, removed});
  }
  return bounds;
}

double largest_diameter_of(const Case& c) {
  double largest = 0;
  for (const ParticleKind& kind : c.kinds) largest = std::max(largest, largest_diameter(kind.size));
  return largest;
}

// Without [domain] min and max: a box round everything, with room for two particles and at least 5 % of its size.
void fit_domain(TableReader& t, Case& c, const Bounds& things) {
  if (!(things.min.x <= things.max.x)) {
    t.fail("min",
           "the domain's min and max are missing and cannot be worked out: nothing but planes bounds the case; give "
           "both, m");
  }
  const Vec3 size = things.max - things.min;
  const double margin = std::max(2 * largest_diameter_of(c), 0.05 * std::max({size.x, size.y, size.z}));
  c.domain = inflated(things, margin);
  t.record("min", c.domain.min, "worked out");
  t.record("max", c.domain.max, "worked out");
}

void read_periodic(TableReader& t, Case& c, bool given) {
  const double skin = c.neighbour.skin > 0 ? c.neighbour.skin : 0.5 * largest_diameter_of(c);
  const double least = 2 * (largest_diameter_of(c) + skin);
  for (const std::string& name : t.texts("periodic", {})) {
    const uint32_t axis = t.index_of("periodic", name, "axis", {"x", "y", "z"});
    if (!given)
      t.fail("periodic",
             fmt::format("{} needs the domain's size; give domain.min and domain.max, m", t.shown("periodic")));
    const double length = along(c.domain.max, static_cast<int>(axis)) - along(c.domain.min, static_cast<int>(axis));
    if (!(length > least)) {
      t.fail("periodic", fmt::format("the domain is {:.6g} m long along periodic {}, must be more than {:.6g} m: twice "
                                     "the largest diameter and skin",
                                     length, name, least));
    }
    c.periodic[axis] = true;
  }
}

void check_regions(TableReader& top, const Case& c) {
  std::vector<TableReader> tables = top.tables("region");
  for (size_t i = 0; i < c.regions.size(); ++i) {
    const Bounds b = bounds_of(c.regions[i]);
    if (contains(c.domain, b.min) && contains(c.domain, b.max)) continue;
    tables[i].fail(
        "shape", fmt::format("region '{}' from {} to {} m is not inside the domain from {} to {} m", c.regions[i].name,
                             text_of(b.min), text_of(b.max), text_of(c.domain.min), text_of(c.domain.max)));
  }
}

void check_outlets(TableReader& top, const Case& c) {
  std::vector<TableReader> tables = top.tables("outlet");
  for (size_t i = 0; i < c.outlets.size(); ++i) {
    const Outlet& outlet = c.outlets[i];
    double reach = 0;  // how far the domain goes on beyond the outlet's plane
    for (int axis = 0; axis < 3; ++axis) {
      const double d = along(outlet.direction, axis);
      reach += d * (along(d > 0 ? c.domain.max : c.domain.min, axis) - along(outlet.point, axis));
    }
    if (!contains(c.domain, outlet.point)) {
      tables[i].fail("point", fmt::format("{} is outside the domain, must be from {} to {} m", tables[i].shown("point"),
                                          text_of(c.domain.min), text_of(c.domain.max)));
    }
    if (reach > outlet.remove_beyond) continue;
    tables[i].fail(
        "remove_beyond",
        fmt::format("{} m: the domain ends {:.6g} m beyond the outlet, so particles would leave the domain before they "
                    "are removed; must be less, or make the domain larger",
                    tables[i].shown("remove_beyond"), reach));
  }
}

void check_meters(TableReader& top, const Case& c) {
  std::vector<TableReader> tables = top.tables("meter");
  for (size_t i = 0; i < c.meters.size(); ++i) {
    const Meter& m = c.meters[i];
    const auto apart = [&](int axis) {
      return along(m.min, axis) >= along(c.domain.max, axis) || along(m.max, axis) <= along(c.domain.min, axis);
    };
    if (apart(0) || apart(1) || apart(2))
      tables[i].fail("min", fmt::format("meter '{}' lies outside the domain, from {} to {} m", m.name,
                                        text_of(c.domain.min), text_of(c.domain.max)));
  }
}

}  // namespace

void read_regions(TableReader& top, Case& c) {
  using Shape = Region::Shape;
  for (TableReader& t : top.tables("region")) {
    Region region;
    region.name = new_name(t, "region", names_of(c.regions));
    region.shape =
        t.choice<Shape>("shape", {{"box", Shape::box}, {"cylinder", Shape::cylinder}, {"frustum", Shape::frustum}});
    if (region.shape == Shape::box) {
      const Bounds box = read_box(t);
      region.min = box.min;
      region.max = box.max;
    } else {
      region.shape == Shape::cylinder ? read_cylinder(t, region) : read_frustum(t, region);
    }
    t.finish();
    c.regions.push_back(region);
  }
}

void read_outlets(TableReader& top, Case& c) {
  for (TableReader& t : top.tables("outlet")) {
    Outlet outlet;
    outlet.name = new_name(t, "outlet", names_of(c.outlets));
    outlet.point = t.vec3("point", kPosition);
    outlet.direction = t.direction("direction", {0, 0, -1});
    outlet.remove_beyond = t.number("remove_beyond", between(0, 1e3, "m"), 2e-3);
    t.finish();
    c.outlets.push_back(outlet);
  }
}

void read_meters(TableReader& top, Case& c) {
  for (TableReader& t : top.tables("meter")) {
    Meter meter;
    meter.name = new_name(t, "meter", names_of(c.meters));
    const Bounds box = read_box(t);
    meter.min = box.min;
    meter.max = box.max;
    t.finish();
    c.meters.push_back(meter);
  }
}

void read_domain(TableReader& top, Case& c, const Bounds& solid) {
  TableReader t = top.table("domain");
  const bool given = t.has("min") || t.has("max");
  if (given) {
    c.domain = read_box(t);
  } else {
    fit_domain(t, c, bounds_of_things(c, solid));
  }
  read_periodic(t, c, given);
  t.finish();
  check_regions(top, c);
  check_outlets(top, c);
  check_meters(top, c);
}

}  // namespace scree
