#include "runtime/simulation.h"

#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <chrono>

#include <cmath>

#include <fmt/format.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/spdlog.h>
#include <nlohmann/json.hpp>

#include "geometry/bounds.h"
#include "kernels/parallel.h"
#include "runtime/case_error.h"
#include "runtime/case_physics.h"
#include "runtime/case_size.h"
#include "runtime/case_writer.h"
#include "runtime/csv_particles.h"
#include "runtime/placement.h"
#include "runtime/progress.h"
#include "runtime/results.h"
#include "runtime/time_scales.h"

namespace scree {

namespace {

struct Interrupted {};

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

constexpr int kStepsPerLook = 50;  // between looks at the clock, the stop flag and a stage's end

struct StageRecord {
  std::string name, kind;
  double start = 0, end = 0;  // s
  size_t particles = 0;       // at the end
};

class Simulation {
 public:
  Simulation(const Case& c, const RunOptions& options, std::shared_ptr<spdlog::logger> log)
      : case_(c),
        options_(options),
        log_(std::move(log)),
        solid_(c.solid),
        engine_(make_engine(c, options.engine)),
        progress_(options.show_progress),
        flow_csv_(options.out / "mass_flow.csv", {"time_s", "discharged_kg", "mass_flow_kg_per_s"}) {
    if (!c.outlets.empty())
      engine_->set_removal([&outlets = case_.outlets](const ParticleState& p) {
        for (size_t k = 0; k < outlets.size(); ++k)
          if (beyond(outlets[k], p, outlets[k].remove_beyond)) return static_cast<int>(k);
        return -1;
      });
    if (!c.meters.empty()) {
      std::vector<std::string> columns{"time_s"};
      for (const Meter& m : c.meters) columns.push_back(m.name + "_kg");
      meters_csv_ = std::make_unique<CsvWriter>(options.out / "meters.csv", columns);
    }
    steps_per_sample_ = std::max<uint64_t>(1, static_cast<uint64_t>(std::llround(c.output.interval / engine_->dt())));
  }

  void run() {
    sample();
    for (size_t k = 0; k < case_.stages.size(); ++k) {
      const Stage& stage = case_.stages[k];
      stage_stream_ = k + 1;
      std::visit([&](const auto& action) { run_stage(stage.name, action); }, stage.action);
      StageRecord& record = records_.back();
      record.end = engine_->time(), record.particles = engine_->count();
      log_->info("stage '{}' ended at t = {:.6g} s with {} particles", record.name, record.end, record.particles);
    }
    check_count();
  }

  const Engine& engine() const { return *engine_; }
  const std::vector<FlowSample>& samples() const { return samples_; }
  const std::vector<StageRecord>& records() const { return records_; }

  double discharged() const {
    double sum = 0;
    for (double d : discharged_by_outlet()) sum += d;
    return sum;
  }

  std::optional<SteadyFlow> steady() const {
    for (const StageRecord& r : records_) {
      if (r.kind != "drain") continue;
      const double end = r.end > r.start ? r.end : engine_->time();
      const OutputSettings& o = case_.output;
      return o.steady_to > 0 ? steady_flow_in(samples_, r.start + o.steady_from, r.start + o.steady_to)
                             : find_steady_flow(samples_, r.start, end);
    }
    return std::nullopt;
  }

 private:
  void begin(const std::string& name, const std::string& kind) {
    records_.push_back({name.empty() ? kind : name, kind, engine_->time(), 0, 0});
    progress_.begin(records_.back().name);
    log_->info("stage '{}' ({}) begins at t = {:.6g} s with {} particles", records_.back().name, kind, engine_->time(),
               engine_->count());
  }
  double stage_time() const { return engine_->time() - records_.back().start; }

  // Steps until done() says so, which it is asked every few steps. share() is for the progress line.
  template <class Done, class Share>
  void advance_until(const Done& done, const Share& share) {
    for (;;) {
      if (done()) return;
      for (int k = 0; k < kStepsPerLook; ++k) {
        engine_->step();
        if (engine_->counters().steps % steps_per_sample_ == 0) sample();
      }
      progress_.update(engine_->time(), engine_->count(), static_cast<double>(engine_->counters().particle_steps),
                       share());
      log_now_and_then();
      if (options_.stop && *options_.stop) throw Interrupted{};
    }
  }

  void run_stage(const std::string& name, const FillStage& s) {
    begin(name, "fill");
    const std::vector<ParticleState> placed = fill(case_, s, solid_, engine_->particles(), stage_stream_);
    engine_->insert(placed);
    log_->info("placed {} particles", placed.size());
  }

  uint32_t kind_named(const CsvParticle& p, const std::string& file) const {
    std::string known;
    for (uint32_t k = 0; k < case_.kinds.size(); ++k) {
      if (case_.kinds[k].name == p.kind) return k;
      known += (k ? ", '" : "'") + case_.kinds[k].name + "'";
    }
    throw CaseError({file, p.line, 1}, fmt::format("no particle kind is named '{}'; the case has {}", p.kind, known));
  }

  void run_stage(const std::string& name, const ReadStage& s) {
    begin(name, "read");
    std::vector<ParticleState> particles;
    for (const CsvParticle& p : read_particles_csv(s.file)) {
      ParticleState state;
      state.kind = p.kind.empty() ? s.kind : kind_named(p, s.file);
      if (!contains(case_.domain, p.position))
        throw CaseError({s.file, p.line, 1},
                        fmt::format("the particle at ({:.6g}, {:.6g}, {:.6g}) m is outside the domain", p.position.x,
                                    p.position.y, p.position.z));
      state.position = p.position, state.velocity = p.velocity, state.radius = p.radius;
      state.mass = sphere_mass(p.radius, case_.materials[case_.kinds[state.kind].material].density);
      particles.push_back(state);
    }
    engine_->insert(particles);
    log_->info("read {} particles from {}", particles.size(), s.file);
  }

  void run_stage(const std::string& name, const PourStage& s) {
    begin(name, "pour");
    Pour pour(case_, s, solid_, stage_stream_);
    double next = 0, last_placed = 0;
    const auto due = [&] {
      if (stage_time() < next) return pour.done();
      const std::vector<ParticleState> placed = pour.batch(stage_time(), engine_->particles());
      if (!placed.empty()) last_placed = stage_time();
      if (stage_time() - last_placed > std::max(0.2, 20 * pour.batch_interval()) && !pour.done())
        throw RunError(
            fmt::format("stage '{}': the region '{}' has been full for {:.3g} s after {:.4g} kg: lower the rate or the "
                        "mass, or pour from higher up",
                        records_.back().name, case_.regions[s.region].name, stage_time() - last_placed, pour.mass()));
      engine_->insert(placed);
      next += pour.batch_interval();
      return pour.done();
    };
    advance_until(due, [&] { return s.mass > 0 ? pour.mass() / s.mass : -1.0; });
  }

  void run_stage(const std::string& name, const SettleStage& s) {
    begin(name, "settle");
    // Particles that have just been placed are at rest before they fall: give them time to fall a diameter.
    const double gravity = norm(case_.gravity);
    const double shortest = std::max(s.min_time, gravity > 0 ? std::sqrt(4 * largest_radius(case_) / gravity) : 0);
    const auto at_rest = [&] {
      if (stage_time() >= s.max_time * (1 - 1e-9) && s.max_time > 0) return true;
      if (s.kinetic_energy_per_particle <= 0 || stage_time() < shortest || engine_->count() == 0) return false;
      const double energy = engine_->sum([](const ParticleState& p) {
        return 0.5 * p.mass * (dot(p.velocity, p.velocity) + 0.4 * p.radius * p.radius * dot(p.spin, p.spin));
      });
      return energy / static_cast<double>(engine_->count()) <= s.kinetic_energy_per_particle;
    };
    advance_until(at_rest, [&] { return s.max_time > 0 ? stage_time() / s.max_time : -1.0; });
    if (s.kinetic_energy_per_particle > 0 && s.max_time > 0 && stage_time() >= s.max_time)
      log_->warn("stage '{}' ended by its longest time {} s, not at rest", records_.back().name, s.max_time);
  }

  void run_stage(const std::string& name, const OpenStage& s) {
    begin(name, "open");
    std::vector<uint32_t> walls;
    for (uint32_t k = 0; k < solid_.walls.size(); ++k)
      if (std::find(s.walls.begin(), s.walls.end(), solid_.walls[k]) != s.walls.end()) walls.push_back(k);
    engine_->open_walls(walls);
    std::erase_if(solid_.primitives,
                  [&](const Primitive& p) { return std::find(walls.begin(), walls.end(), p.wall) != walls.end(); });
  }

  void run_stage(const std::string& name, const DrainStage& s) {
    begin(name, "drain");
    const double present = engine_->sum([](const ParticleState&p) { return p.mass; }), before = discharged();
    double last_mass = before, last_change = 0;
    const auto drained = [&] { return present > 0 ? (discharged() - before) / present : 1.0; };
    const auto over = [&] {
      if (s.max_time > 0 && stage_time() >= s.max_time * (1 - 1e-9)) return true;
      if (engine_->count() == 0) return true;
      if (s.discharged_fraction > 0 && drained() >= s.discharged_fraction) return true;
      if (const double now = discharged(); now > last_mass) last_mass = now, last_change = stage_time();
      return s.no_flow_time > 0 && last_mass > before && stage_time() - last_change >= s.no_flow_time;
    };
    advance_until(over, [&] {
      const double by_time = s.max_time > 0 ? stage_time() / s.max_time : 0;
      return std::max(by_time, s.discharged_fraction > 0 ? drained() / s.discharged_fraction : 0);
    });
    sample();
  }

  std::vector<double> discharged_by_outlet() const {
    std::vector<double> kg(case_.outlets.size(), 0.0);
    for (size_t k = 0; k < kg.size(); ++k) {
      const auto& removed = engine_->counters().removed_mass;
      kg[k] = (k < removed.size() ? removed[k] : 0) +
              engine_->sum([&](const ParticleState& p) { return beyond(case_.outlets[k], p) ? p.mass : 0.0; });
    }
    return kg;
  }

  void sample() {
    if (!samples_.empty() && samples_.back().time >= engine_->time()) return;
    FlowSample now{engine_->time(), discharged_by_outlet()};
    const double rate =
        samples_.empty() ? 0 : (now.total() - samples_.back().total()) / (now.time - samples_.back().time);
    flow_csv_.row(std::array{now.time, now.total(), rate});
    samples_.push_back(std::move(now));
    if (!meters_csv_) return;
    std::vector<double> row{engine_->time()};
    for (const Meter& m : case_.meters)
      row.push_back(engine_->sum([&](const ParticleState& p) {
        const Vec3& x = p.position;
        return x.x >= m.min.x && x.x <= m.max.x && x.y >= m.min.y && x.y <= m.max.y && x.z >= m.min.z && x.z <= m.max.z
                   ? p.mass
                   : 0.0;
      }));
    meters_csv_->row(row);
  }

  void log_now_and_then() {
    if (seconds_since(last_log_) < 10) return;
    last_log_ = Clock::now();
    const EngineCounters& k = engine_->counters();
    log_->info("t = {:.6g} s  {} particles  {:.3g} m/s at most  {} steps  {} rebuilds  skin {:.3g} m", engine_->time(),
               engine_->count(), engine_->max_speed(), k.steps, k.rebuilds, engine_->skin());
  }

  void check_count() const {
    const EngineCounters& k = engine_->counters();
    if (k.inserted != k.removed + engine_->count())
      throw RunError(fmt::format("{} particles went in, {} left through outlets, {} are left: {} lost", k.inserted,
                                 k.removed, engine_->count(),
                                 static_cast<int64_t>(k.inserted - k.removed - engine_->count())));
  }

  const Case& case_;
  const RunOptions& options_;
  std::shared_ptr<spdlog::logger> log_;
  Solid solid_;  // with the walls that are still there
  std::unique_ptr<Engine> engine_;
  Progress progress_;
  CsvWriter flow_csv_;
  std::unique_ptr<CsvWriter> meters_csv_;
  uint64_t steps_per_sample_ = 1, stage_stream_ = 0;
  std::vector<FlowSample> samples_;
  std::vector<StageRecord> records_;
  Clock::time_point last_log_ = Clock::now();
};

const char* text(RunStatus s) {
  return s == RunStatus::done ? "done" : s == RunStatus::interrupted ? "interrupted" : "failed";
}

nlohmann::json summary_of(const Case& c, const Simulation& simulation, const RunResult& result, double wall) {
  const Engine& e = simulation.engine();
  const EngineCounters& k = e.counters();
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  nlohmann::json j;
  j["title"] = c.title, j["case"] = c.source, j["status"] = text(result.status);
  if (!result.message.empty()) j["message"] = result.message;
  j["particles"] = k.inserted, j["particles_left"] = e.count(), j["steps"] = k.steps;
  j["time_step_s"] = e.dt(), j["physical_time_s"] = e.time(), j["wall_time_s"] = wall;
  j["particle_steps"] = k.particle_steps,
  j["particle_steps_per_second"] = wall > 0 ? static_cast<double>(k.particle_steps) / wall : 0;
  j["peak_rss_bytes"] = static_cast<uint64_t>(usage.ru_maxrss) * 1024;
  j["threads"] = thread_count(), j["isa"] = e.isa();
  j["mass_discharged_kg"] = simulation.discharged();
  j["mass_retained_kg"] = e.sum([&](const ParticleState& p) {
    for (const Outlet& o : c.outlets)
      if (beyond(o, p)) return 0.0;
    return p.mass;
  });
  if (result.steady) {
    j["steady_mass_flow_kg_per_s"] = result.steady->rate,
    j["steady_mass_flow_standard_error_kg_per_s"] = result.steady->standard_error;
    j["steady_window_s"] = {result.steady->from, result.steady->to}, j["steady_bins"] = result.steady->bins;
  } else {
    j["steady_mass_flow_kg_per_s"] = nullptr, j["steady_mass_flow_standard_error_kg_per_s"] = nullptr,
    j["steady_window_s"] = nullptr;
  }
  j["rebuilds"] = k.rebuilds;
  j["lost_particles"] =
      static_cast<int64_t>(k.inserted) - static_cast<int64_t>(k.removed) - static_cast<int64_t>(e.count());
  j["state_hash"] = fmt::format("{:016x}", e.state_hash());
  j["porosity"] = c.fibres.count > 0 ? nlohmann::json(c.fibres.porosity) : nlohmann::json();
  j["fibres"] = c.fibres.count;
  for (const StageRecord& r : simulation.records())
    j["stages"].push_back({{"name", r.name},
                           {"kind", r.kind},
                           {"start_s", r.start},
                           {"end_s", std::max(r.start, r.end)},
                           {"particles", r.particles}});
  j["wall_seconds"] = {{"step", k.step_seconds},
                       {"history", k.history_seconds},
                       {"sort", k.sort_seconds},
                       {"pair_search", k.pair_search_seconds},
                       {"solid_search", k.solid_search_seconds}};
  return j;
}

std::shared_ptr<spdlog::logger> make_log(const std::filesystem::path& out) {
  try {
    auto log = std::make_shared<spdlog::logger>(
        "scree", std::make_shared<spdlog::sinks::basic_file_sink_mt>((out / "run.log").string(), true));
    log->set_pattern("%Y-%m-%d %H:%M:%S.%e %l %v");
    log->flush_on(spdlog::level::info);
    return log;
  } catch (const spdlog::spdlog_ex& e) {
    throw RunError(e.what());
  }
}

}  // namespace

RunResult run_case(const Case& c, const RunOptions& options) {
  const auto start = Clock::now();
  RunResult result;
  result.out = options.out;
  std::unique_ptr<Simulation> simulation;
  std::shared_ptr<spdlog::logger> log;
  const auto fail = [&](const std::string& why) {
    result.status = RunStatus::failed, result.message = why;
    if (log) log->error(why);
  };
  try {
    std::error_code error;
    std::filesystem::create_directories(options.out, error);
    if (error)
      throw RunError(fmt::format("cannot make the results folder {}: {}", options.out.string(), error.message()));
    log = make_log(options.out);
    if (options.threads > 0) set_thread_count(options.threads);
    write_file(options.out / "case.toml", write_case(c));
    log->info("{}", describe_case(c));
    for (const std::string& warning : time_step_warnings(c)) log->warn(warning);
    simulation = std::make_unique<Simulation>(c, options, log);
    log->info("{} threads, {} kernels", thread_count(), simulation->engine().isa());
    simulation->run();
  } catch (const Interrupted&) {
    result.status = RunStatus::interrupted;
    log->warn("interrupted at t = {:.6g} s", simulation->engine().time());
  } catch (const RunError& e) {
    fail(e.what());
  } catch (const std::bad_alloc&) {
    fail("out of memory: run fewer particles, or on a machine with more; `scree check` prints what a case needs");
  }
  if (!simulation) return result;
  try {
    result.steady = simulation->steady();
    write_file(options.out / "summary.json", summary_of(c, *simulation, result, seconds_since(start)).dump(2) + "\n");
    if (c.output.final_vtk) write_particles_vtp(options.out / "particles.vtp", simulation->engine().particles());
    log->info("{}", text(result.status));
  } catch (const RunError& e) {
    fail(result.message.empty() ? e.what() : result.message + "; and " + e.what());
  }
  return result;
}

}  // namespace scree
