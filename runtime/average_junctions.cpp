#include "runtime/average_junctions.h"

#include <algorithm>
#include <cmath>

#include "geometry/solid_index.h"
#include "runtime/case_physics.h"
#include "runtime/junctions.h"

namespace scree {

namespace {

constexpr int kPoints = 5;  // of a line

struct Probe {
  double solid_fraction = 0, speed = 0, downward = 0;
  int lines = 0, points = 0, moving = 0;
};

// How far from the junction along `way` a grain's centre can be at the nearest; negative: nowhere near.
double way_out(const SolidIndex& index, const Case& c, const Vec3& from, const Vec3& way, double grain) {
  const double step = 0.05 * grain;
  std::vector<uint32_t> near;
  for (int k = 1; k < 1000; ++k) {
    near.clear();
    index.query(from + (k * step) * way, grain, near);
    const bool blocked = std::ranges::any_of(near, [&](uint32_t p) { return c.solid.primitives[p].radius > 0; });
    if (!blocked) return k * step;
  }
  return -1;
}

void look_along(const CoarseGrid& grid, const AverageFields& f, const Vec3& start, const Vec3& way, double length,
                const Vec3& down, Probe& probe) {
  if (!grid.holds(start) || !grid.holds(start + length * way)) return;
  ++probe.lines;
  for (int k = 0; k < kPoints; ++k) {
    const size_t cell = grid.cell_of(start + (length * (k + 0.5) / kPoints) * way);
    probe.solid_fraction += f.solid_fraction[cell], ++probe.points;
    if (std::isnan(f.velocity[cell].x)) continue;
    probe.speed += norm(f.velocity[cell]), probe.downward += dot(f.velocity[cell], down), ++probe.moving;
  }
}

nlohmann::json text_of(const Probe& p) {
  if (p.points == 0) return nullptr;
  const auto mean = [&](double sum) { return p.moving > 0 ? nlohmann::json(sum / p.moving) : nlohmann::json(); };
  return {{"lines", p.lines},
          {"solid_fraction", p.solid_fraction / p.points},
          {"speed_m_per_s", mean(p.speed)},
          {"downward_velocity_m_per_s", mean(p.downward)}};
}

}  // namespace

nlohmann::json junction_summary(const Case& c, const CoarseGrid& grid, const AverageFields& fields) {
  std::vector<Vec3> junctions = Junctions(c.solid).points();
  std::erase_if(junctions, [&](const Vec3& x) { return !grid.holds(x); });
  if (junctions.empty() || norm(c.gravity) == 0) return nullptr;
  const auto index = make_embree_index(c.solid);
  const Vec3 down = unit(c.gravity);
  const double grain = largest_radius(c);
  Probe above, below;
  for (const Vec3& at : junctions)
    for (const Vec3& way : {-down, down}) {
      const double out = way_out(*index, c, at, way, grain);
      if (out > 0) look_along(grid, fields, at + out * way, way, 2 * grain, down, dot(way, down) < 0 ? above : below);
    }
  return {{"count", junctions.size()}, {"above", text_of(above)}, {"below", text_of(below)}};
}

}  // namespace scree
