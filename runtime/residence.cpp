#include "runtime/residence.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "runtime/junctions.h"
#include "runtime/residence_pictures.h"
#include "runtime/results.h"
#include "runtime/timer.h"

namespace scree {

namespace {

constexpr double kAboutBins = 50;

bool is_drain(const Stage& stage) { return std::holds_alternative<DrainStage>(stage.action); }

// The smallest of 1, 2, 5, 10, 20, ... x power of ten that is at least `least`.
double round_width(double least) {
  const double decade = std::pow(10.0, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * decade >= least * (1 - 1e-9)) return factor * decade;
  return 10 * decade;
}

void write_times(const std::filesystem::path& path, const std::vector<ResidenceBin>& bins) {
  CsvWriter csv(path, {"from_s", "to_s", "mass_kg"});
  for (const ResidenceBin& bin : bins) csv.row(std::array{bin.from, bin.to, bin.mass});
}

void write_retained(const std::filesystem::path& path, const std::vector<Retained>& retained) {
  CsvWriter csv(path, {"x_m", "y_m", "z_m", "mass_kg", "grains", "near_kg", "near_grains", "along_fibres_kg",
                       "along_fibres_grains"});
  for (const Retained& r : retained)
    csv.row(std::array{r.at.x, r.at.y, r.at.z, r.mass, r.grains, r.near_mass, r.near_grains, r.mass_along_fibres(),
                       r.grains_along_fibres()});
}

}  // namespace

double ResidenceTimes::mass() const {
  double sum = 0;
  for (const auto& [time, mass] : taken) sum += mass;
  return sum;
}

double ResidenceTimes::mean() const {
  double sum = 0;
  for (const auto& [time, mass] : taken) sum += time * mass;
  return sum / mass();
}

double ResidenceTimes::quantile(double share) const {
  const double wanted = share * mass();
  double sum = 0;
  for (const auto& [time, mass] : taken) {
    sum += mass;
    if (sum >= wanted) return time;
  }
  return taken.back().first;
}

std::vector<ResidenceBin> bins_of(const ResidenceTimes& times, double width, double finest) {
  std::vector<ResidenceBin> bins;
  if (times.taken.empty()) return bins;
  const double longest = times.taken.back().first;
  if (width == 0) width = round_width(std::max(finest, longest / kAboutBins));
  for (const auto& [time, mass] : times.taken) {
    const auto k = static_cast<size_t>(time / width);
    while (bins.size() <= k) {
      const double from = static_cast<double>(bins.size()) * width;
      bins.push_back({from, from + width, 0});
    }
    bins[k].mass += mass;
  }
  return bins;
}

Residence::Residence(const Case& c, double dt)
    : settings_(c.output.residence),
      schedule_({.interval = c.output.residence.interval}, dt),
      waits_for_drain_(std::ranges::any_of(c.stages, is_drain)) {}

bool Residence::counts(const RunView& run) const {
  return counting_ || !waits_for_drain_ || std::ranges::any_of(run.c.stages, [&](const Stage& s) {
           return is_drain(s) && run.stage == (s.name.empty() ? "drain" : s.name);
         });
}

// When a grain that was at track.height at the last look and is at `height` now passed the plane, s.
float Residence::crossing(const Track& track, double height, double plane, double time) const {
  const double share = std::clamp((track.height - plane) / (track.height - height), 0.0, 1.0);
  return static_cast<float>(last_look_ + share * (time - last_look_));
}

void Residence::see(Track& track, const ParticleState& p, double time) {
  const double height = p.position.z;
  if (track.look == 0) {
    track.mass = static_cast<float>(p.mass);
    if (height < settings_.entry) track.entry = kBefore;
    if (height < settings_.exit) track.exit = kBefore;
  } else {
    if (track.entry == kNot && height < settings_.entry)
      track.entry = counting_ ? crossing(track, height, settings_.entry, time) : kBefore;
    if (track.exit == kNot && height < settings_.exit) track.exit = crossing(track, height, settings_.exit, time);
  }
  track.height = static_cast<float>(height), track.look = looks_;
}

void Residence::look(const RunView& run) {
  const Timer timer(seconds_);
  const double time = run.engine.time();
  counting_ = counts(run);
  ++looks_;
  tracks_.resize(run.engine.counters().inserted);
  // A visit to every particle on all threads; each writes what belongs to its id alone.
  run.engine.sum([&](const ParticleState& p) {
    see(tracks_[p.id], p, time);
    return 0.0;
  });
  // Who was there at the last look and is not now has left the run, some time in between.
  const auto between = static_cast<float>(0.5 * (last_look_ + time));
  for (Track& track : tracks_)
    if (track.look != 0 && track.look != looks_ && track.exit == kNot)
      track.exit = track.entry == kNot ? kBefore : between;
  last_look_ = time;
}

ResidenceTimes Residence::times() const {
  ResidenceTimes times;
  for (const Track& track : tracks_)
    if (track.went_through()) times.taken.emplace_back(track.exit - track.entry, track.mass);
  std::ranges::sort(times.taken);
  return times;
}

void Residence::finish(const RunView& run) {
  const ResidenceTimes times = this->times();
  const bool any = !times.taken.empty();
  const auto seconds = [&](auto value) { return any ? nlohmann::json(value()) : nlohmann::json(); };
  double entered = 0;
  for (const Track& track : tracks_) entered += track.entry >= 0 ? track.mass : 0;
  summary_ = {{"entry_z_m", settings_.entry},
              {"exit_z_m", settings_.exit},
              {"resolution_s", settings_.interval},
              {"seconds", seconds_},
              {"entered_kg", entered},
              {"went_through_kg", times.mass()},
              {"grains_through", times.taken.size()},
              {"mean_s", seconds([&] { return times.mean(); })},
              {"p10_s", seconds([&] { return times.quantile(0.1); })},
              {"median_s", seconds([&] { return times.quantile(0.5); })},
              {"p90_s", seconds([&] { return times.quantile(0.9); })}};
  const std::vector<ResidenceBin> bins = bins_of(times, settings_.bin, settings_.interval);
  const std::vector<Retained> retained = find_retained(run);
  write_times(run.out / "residence.csv", bins);
  if (!retained.empty()) write_retained(run.out / "retained.csv", retained);
  write_residence_pictures(run.out / "residence", run.c, bins, retained, entered);
}

std::vector<Retained> Residence::find_retained(const RunView& run) {
  const Junctions junctions(run.solid);
  std::vector<Retained> at;
  for (const Vec3& point : junctions.points()) at.push_back({.at = point});
  Retained all, elsewhere;
  for (const ParticleState& p : each_particle(run.engine)) {
    if (p.position.z > settings_.entry || p.position.z < settings_.exit) continue;
    const auto junction = junctions.nearest(p.position);
    for (Retained* left : {&all, junction ? &at[*junction] : &elsewhere}) left->mass += p.mass, ++left->grains;
    if (!junction || norm(p.position - at[*junction].at) > junctions.near()) continue;
    for (Retained* left : {&all, &at[*junction]}) left->near_mass += p.mass, ++left->near_grains;
  }
  summary_["retained_kg"] = all.mass, summary_["retained_grains"] = static_cast<uint64_t>(all.grains);
  summary_["retained_near_junctions_kg"] = all.near_mass;
  summary_["retained_near_junctions_grains"] = static_cast<uint64_t>(all.near_grains);
  summary_["retained_along_fibres_kg"] = all.mass_along_fibres() - elsewhere.mass;
  summary_["retained_along_fibres_grains"] = static_cast<uint64_t>(all.grains_along_fibres() - elsewhere.grains);
  summary_["retained_at_no_junction_kg"] = elsewhere.mass;
  return at;
}

void Residence::save(StateWriter& out, const std::string& at) const {
  out.save(at + "/looks", looks_), out.save(at + "/last_look", last_look_), out.save(at + "/counting", counting_);
  out.save(at + "/tracks", tracks_);
}

void Residence::load(StateReader& in, const std::string& at) {
  in.load(at + "/looks", looks_), in.load(at + "/last_look", last_look_), in.load(at + "/counting", counting_);
  in.load(at + "/tracks", tracks_);
}

}  // namespace scree
