#include "runtime/averages.h"

#include <cmath>

#include "runtime/average_files.h"
#include "runtime/average_junctions.h"
#include "runtime/average_lanes.h"
#include "runtime/during.h"
#include "runtime/timer.h"

namespace scree {

namespace {

// What the sums hold in all, and what the fields come to in the mean over what fibres leave free.
nlohmann::json totals(const CoarseGrid& grid, const AverageFields& f) {
  double mass = 0, solid = 0, free = 0, energy = 0;
  Vec3 momentum{0, 0, 0};
  for (size_t k = 0; k < grid.size(); ++k) {
    mass += f.bulk_density[k], solid += f.solid_fraction[k], free += f.free_share[k];
    momentum += f.mass_flux[k];
    if (f.bulk_density[k] > 0) energy += f.bulk_density[k] * f.temperature[k];
  }
  nlohmann::json j;
  j["mass_kg"] = mass * grid.cell_volume();
  j["solid_fraction_of_free_space"] = free > 0 ? nlohmann::json(solid / free) : nlohmann::json();
  if (mass > 0) {
    const Vec3 u = 1 / mass * momentum;
    j["mean_velocity_m_per_s"] = {u.x, u.y, u.z};
    j["granular_temperature_m2_per_s2"] = energy / mass;
  }
  return j;
}

}  // namespace

Averages::Averages(const Case& c, const AverageSettings& settings, double dt)
    : settings_(settings), schedule_(settings.moments, dt), sums_(grid_of(settings, c)) {}

void Averages::look(const RunView& run) {
  const uint64_t step = run.engine.counters().steps;
  if (step == last_step_ || !counts(settings_.during, run)) return;
  Timer t(seconds_);
  last_step_ = step;
  if (sums_.looks() == 0) from_ = run.engine.time();
  to_ = run.engine.time();
  sums_.add(run.engine, run.c);
}

void Averages::finish(const RunView& run) {
  const CoarseGrid& grid = sums_.grid();
  summary_ = {{"looks", sums_.looks()}, {"seconds", seconds_}};
  if (sums_.looks() == 0) return;
  const AverageFields fields = sums_.fields(run.c);
  summary_.update(totals(grid, fields));
  summary_["window_s"] = {from_, to_};
  summary_["cells"] = grid.cells, summary_["spacing_m"] = {grid.spacing.x, grid.spacing.y, grid.spacing.z};
  summary_["kernel"] = {{"name", "Lucy along each axis"}, {"half_width_m", grid.width}};
  if (const nlohmann::json junctions = junction_summary(run.c, grid, fields); !junctions.is_null())
    summary_["junctions"] = junctions;
  if (const nlohmann::json lanes = lane_summary(run.c, grid, fields); !lanes.is_null()) summary_["lanes"] = lanes;
  write_average(run.out / "averages", settings_.name, run.c, grid, fields);
}

void Averages::save(StateWriter& out, const std::string& at) const {
  out.save(at + "/last_step", last_step_), out.save(at + "/from", from_), out.save(at + "/to", to_);
  out.save(at + "/seconds", seconds_);
  sums_.save(out, at);
}

void Averages::load(StateReader& in, const std::string& at) {
  in.load(at + "/last_step", last_step_), in.load(at + "/from", from_), in.load(at + "/to", to_);
  in.load(at + "/seconds", seconds_);
  sums_.load(in, at);
}

}  // namespace scree
