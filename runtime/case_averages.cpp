// [[output.average]] and [output.touch]: what is measured, when, and how finely.
#include <algorithm>
#include <cmath>

#include "geometry/bounds.h"
#include "kernels/coarse_grain.h"
#include "runtime/average_grid.h"
#include "runtime/case_moments.h"
#include "runtime/case_physics.h"
#include "runtime/case_sections.h"
#include "runtime/case_size.h"
#include "runtime/memory.h"
#include "runtime/touch_surface.h"

namespace scree {

namespace {

constexpr double kDefaultCells = 1e6;       // that an average of default spacing has at most
constexpr double kMostCells = 1e9;          // of an average or a touch map
constexpr double kDefaultWallCells = 40e3;  // of one plane of a wall, at most, when the cell is the default
constexpr int kStepsBetweenTouches = 80;    // a look costs about a step

bool has_drain(const Case& c) {
  return std::ranges::any_of(c.stages, [](const Stage& s) { return std::holds_alternative<DrainStage>(s.action); });
}

// `during`: without it "steady" if there is such a window, else "drain" if there is such a stage; with moments of its
// own a table is free of stages.
During read_during(TableReader& t, const Case& c) {
  const bool own_moments = t.has("window") || t.has("times");
  const bool steady = c.output.steady_to > 0 && has_drain(c);
  const char* fallback = own_moments || !has_drain(c) ? "always" : steady ? "steady" : "drain";
  const During during = t.choice<During>(
      "during", {{"always", During::always}, {"drain", During::drain}, {"steady", During::steady}}, fallback);
  if (during == During::steady && c.output.steady_to == 0)
    t.fail("during", "\"steady\" needs [output] steady_window = [from, to], s after the drain began");
  if (during != During::always && !has_drain(c))
    t.fail("during", fmt::format("{} never comes: no stage is of kind \"drain\"", t.shown("during")));
  return during;
}

// At intervals, unless the table names moments of another kind.
Moments default_moments(TableReader& t, double interval) {
  Moments moments;
  if (!t.has("times") && (!t.has("stage_ends") || t.has("interval"))) moments.interval = interval;
  return moments;
}

// ---- [[output.average]]

// The lattice's section with two grain diameters above and below, as far as the domain reaches.
Bounds default_box(const Case& c) {
  const double margin = 4 * largest_radius(c);
  const Bounds &s = c.fibres.section, &d = c.domain;
  return {{std::max(s.min.x, d.min.x), std::max(s.min.y, d.min.y), std::max(s.min.z - margin, d.min.z)},
          {std::min(s.max.x, d.max.x), std::min(s.max.y, d.max.y), std::min(s.max.z + margin, d.max.z)}};
}

bool has_section(const Case& c) { return c.fibres.count > 0 && volume_of(c.fibres.section) > 0; }

void read_box(TableReader& t, const Case& c, AverageSettings& average) {
  if (!has_section(c) || t.has("min") || t.has("max")) {
    average.box.min = t.vec3("min", kPosition), average.box.max = t.vec3("max", kPosition);
  } else {
    const Bounds box = default_box(c);
    average.box.min = t.vec3("min", kPosition, box.min), average.box.max = t.vec3("max", kPosition, box.max);
  }
  const Vec3 edges = average.box.max - average.box.min;
  for (const auto& [axis, edge] : {std::pair{'x', edges.x}, {'y', edges.y}, {'z', edges.z}})
    if (!(edge > 0))
      t.fail("max", fmt::format("{} is not above min = {} along {}", t.shown("max"), t.shown("min"), axis));
  const Bounds& d = c.domain;
  if (average.box.min.x < d.min.x || average.box.min.y < d.min.y || average.box.min.z < d.min.z ||
      average.box.max.x > d.max.x || average.box.max.y > d.max.y || average.box.max.z > d.max.z)
    t.fail("min", fmt::format("the box from {} to {} m is not inside the domain from [{:g}, {:g}, {:g}] to [{:g}, "
                              "{:g}, {:g}] m",
                              t.shown("min"), t.shown("max"), d.min.x, d.min.y, d.min.z, d.max.x, d.max.y, d.max.z));
}

// Of the form 1, 1.5, 2, 3, 5 or 7 times a power of ten: the least that is at least x.
double rounded_up(double x) {
  const double power = std::pow(10, std::floor(std::log10(x)));
  for (const double step : {1.0, 1.5, 2.0, 3.0, 5.0, 7.0})
    if (step * power >= x * (1 - 1e-9)) return step * power;
  return 10 * power;
}

void read_grid(TableReader& t, const Case& c, AverageSettings& average) {
  const double volume = volume_of(average.box), grain = 2 * largest_radius(c);
  const double coarsest = std::cbrt(volume / kDefaultCells);
  average.spacing = t.number("spacing", kLength, coarsest <= 0.5 * grain ? 0.5 * grain : rounded_up(coarsest));
  const double cells = volume / std::pow(average.spacing, 3);
  if (!(cells <= kMostCells))
    t.fail("spacing",
           fmt::format("{} m makes {:.3g} cells, must be at most {:g}", t.shown("spacing"), cells, kMostCells));
  require_memory(t.place("spacing"), fmt::format("the cells of average '{}' need", average.name),
                 memory_of_average(average));
  const Vec3 edge = grid_of(average, c).spacing;
  const double longest = std::max({edge.x, edge.y, edge.z}), shortest = std::min({edge.x, edge.y, edge.z});
  const double most = CoarseGrid::kWidestKernel * shortest;
  average.width = t.number("width", kLength, std::clamp(grain, 1.5 * longest, std::max(1.5 * longest, most)));
  if (average.width < longest || average.width > most)
    t.fail("width", fmt::format("{} m is out of range, must be between {:.4g} and {:.4g} m, 1 to {} edges of a cell: "
                                "the kernel must be resolved by the grid",
                                t.shown("width"), longest, most, CoarseGrid::kWidestKernel));
}

AverageSettings read_average(TableReader& t, const Case& c) {
  AverageSettings average;
  average.name = new_name(t, "average", names_of(c.output.averages));
  read_box(t, c, average);
  read_grid(t, c, average);
  average.during = read_during(t, c);
  // In which a grain falls an eighth of its diameter from rest: sooner it is seen nearly in the same place.
  const double fall = 0.5 * std::sqrt(2 * largest_radius(c) / std::max(norm(c.gravity), 1e-3));
  average.moments = read_moments(t, default_moments(t, rounded_up(fall)));
  t.finish();
  return average;
}

// ---- [output.touch]

std::vector<std::string> plane_walls(const Case& c, bool with_opened) {
  std::vector<std::string> names;
  for (uint32_t w = 0; w < c.solid.walls.size(); ++w) {
    const bool plane = std::ranges::any_of(c.solid.primitives, [&](const Primitive& p) {
      return p.wall == w && std::holds_alternative<Quad>(p.skeleton) && p.radius == 0;
    });
    if (plane && (with_opened || !is_opened(c, w))) names.push_back(c.solid.walls[w]);
  }
  return names;
}

void read_touch_walls(TableReader& t, const Case& c, TouchSettings& touch) {
  const std::vector<std::string> all = plane_walls(c, true);
  for (const std::string& name : t.texts("walls", plane_walls(c, false))) {
    t.index_of("walls", name, "wall of plane faces", all);
    touch.walls.push_back(t.index_of("walls", name, "wall", c.solid.walls));
  }
}

double largest_face(const Case& c, const TouchSettings& touch) {
  double area = 0;
  for (const Primitive& p : c.solid.primitives)
    if (is_mapped_face(p, touch)) area = std::max(area, area_of_rectangle_round(std::get<Quad>(p.skeleton)));
  return area;
}

void read_touch_cells(TableReader& t, const Case& c, TouchSettings& touch) {
  const double grain = 2 * largest_radius(c), by_walls = std::sqrt(largest_face(c, touch) / kDefaultWallCells);
  touch.cell = t.number("cell", kLength, by_walls <= grain ? grain : rounded_up(by_walls));
  touch.around = t.whole("around", between(4, 360, "cells"), touch.around);
  if (touch.around % 4)
    t.fail("around",
           fmt::format("{} must be a multiple of 4: a fibre has an upper and a lower half", t.shown("around")));
  const double cells = cells_of_touch(c);
  if (!(cells <= kMostCells))
    t.fail("cell", fmt::format("{} m makes {:.3g} cells, must be at most {:g}", t.shown("cell"), cells, kMostCells));
  require_memory(t.place("cell"), "the cells of touch maps need", cells * kBytesPerTouchCell);
}

}  // namespace

void read_averages(TableReader& output, Case& c) {
  std::vector<TableReader> tables = output.tables("average");
  const bool by_default = output.flag("default_average", true) && tables.empty() && has_section(c) && has_drain(c);
  if (by_default) {
    tables.push_back(output.added_table("average"));
    tables.back().text("name", "lattice");
  }
  for (TableReader& t : tables) c.output.averages.push_back(read_average(t, c));
}

void read_touch(TableReader& output, Case& c) {
  TableReader t = output.table("touch");
  TouchSettings& touch = c.output.touch;
  touch.enabled = t.flag("enabled", c.fibres.count > 0 && has_drain(c));
  for (const char* key : {"walls", "cell", "around", "during", "interval", "times", "stage_ends", "window"})
    if (!touch.enabled && t.has(key)) t.fail(key, fmt::format("{} has no effect with enabled = false", t.shown(key)));
  if (touch.enabled) {
    read_touch_walls(t, c, touch);
    read_touch_cells(t, c, touch);
    touch.during = read_during(t, c);
    touch.moments = read_moments(t, default_moments(t, kStepsBetweenTouches * time_step_of(c)));
  }
  t.finish();
}

}  // namespace scree
