// The stages of a run, one after the other: what simulation.cpp starts, resumes and reports on.
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "geometry/bounds.h"
#include "runtime/case_error.h"
#include "runtime/case_physics.h"
#include "runtime/checkpoint.h"
#include "runtime/csv_particles.h"
#include "runtime/observer.h"
#include "runtime/placement.h"
#include "runtime/progress.h"
#include "runtime/results.h"
#include "runtime/run_state.h"
#include "runtime/simulation.h"
#include "runtime/watch.h"

namespace scree {

struct Interrupted {};  // thrown where a request to stop is heeded

using Clock = std::chrono::steady_clock;
inline double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

inline constexpr int kStepsPerLook = 50;  // between looks at the clock and a stage's end

class Simulation {
 public:
  Simulation(const Case& c, const RunOptions& options, std::shared_ptr<spdlog::logger> log)
      : case_(c),
        options_(options),
        log_(std::move(log)),
        solid_(c.solid),
        engine_(make_engine(c, options.engine)),
        watch_(c),
        progress_(options.show_progress),
        checkpoints_(options.out, c.checkpoint.keep) {
    state_.source = c.source;
    if (!c.outlets.empty())
      engine_->set_removal([&outlets = case_.outlets](const ParticleState& p) {
        for (size_t k = 0; k < outlets.size(); ++k)
          if (beyond(outlets[k], p, outlets[k].remove_beyond)) return static_cast<int>(k);
        return -1;
      });
    steps_per_sample_ = std::max<uint64_t>(1, static_cast<uint64_t>(std::llround(c.output.interval / engine_->dt())));
    observers_ = make_observers(c, options.out, engine_->dt());
    plan_looks();
  }

  // From the beginning, or from what load() brought.
  void run() {
    open_tables();
    if (state_.samples.empty()) sample();
    if (!resumed_from_.empty()) keep_watch(true);  // what the next look is held against
    while (state_.stage < case_.stages.size()) {
      heed_stop();
      const Stage& stage = case_.stages[state_.stage];
      std::visit([&](const auto& action) { run_stage(stage.name, action); }, stage.action);
      StageRecord& record = state_.records.back();
      record.end = engine_->time(), record.particles = engine_->count();
      log_->info("stage '{}' ended at t = {:.6g} s with {} particles", record.name, record.end, record.particles);
      for (const auto& o : observers_)
        if (o->schedule().stage_ends()) o->look(view());
      ++state_.stage, state_.begun = false;
      pour_.reset();
      keep_watch(true);
      write_checkpoint();
    }
    check_count(*engine_);
  }

  void write_checkpoint() {
    if (case_.checkpoint.keep > 0) note(checkpoints_.write(engine_->counters().steps, saver("")));
    last_checkpoint_ = Clock::now();
  }
  // The state as the failure left it; nothing goes on from it.
  void write_failed_checkpoint(const std::string& why) {
    if (case_.checkpoint.keep > 0) note(checkpoints_.write_failed(engine_->counters().steps, saver(why)));
  }
  // Throws CheckpointRefused; the simulation is of no use then.
  void load(const std::filesystem::path& checkpoint) {
    Checkpoints::read(checkpoint, [&](StateReader& in) { load(in); });
    resumed_from_ = checkpoint.filename().string();
  }
  // Throws CheckpointRefused, StateRefused or Hdf5Error.
  void load(StateReader& in) {
    CheckpointHead head;
    in.load("head", head);
    check_head(head, case_);
    in.load("run", state_);
    require_sound(state_, case_);
    engine_->load(in);
    for (size_t k = 0; k < state_.stage; ++k)
      if (const auto* open = std::get_if<OpenStage>(&case_.stages[k].action)) take_out(walls_of(*open));
    if (const auto* pour = state_.begun ? std::get_if<PourStage>(&case_.stages[state_.stage].action) : nullptr) {
      in.load("pour", make_pour(*pour));
      require_state(pour_->is_sound(), "its pour is at an impossible place");
    }
    for (const auto& o : observers_)  // one that the case has only now begins now
      if (const std::string at = "observers/" + o->name(); in.has(at)) o->load(in, at);
    plan_looks();
    wall_before_ = state_.wall_seconds;
  }

  // Whatever the end: what the observers have becomes complete. What could not be written, in words; one that fails
  // keeps none of the others from writing theirs.
  std::string finish_observers() {
    std::string failed;
    for (const auto& o : observers_) {
      if (state_.records.empty()) break;
      try {
        o->finish(view());
      } catch (const std::bad_alloc&) {
        throw;
      } catch (const std::exception& e) {
        failed += (failed.empty() ? "" : "; and ") + std::string(e.what());
      }
    }
    return failed;
  }

  const Engine& engine() const { return *engine_; }
  const std::vector<std::unique_ptr<Observer>>& observers() const { return observers_; }
  const RunState& state() const { return state_; }
  const std::string& resumed_from() const { return resumed_from_; }
  int checkpoints_written() const { return checkpoints_written_; }
  double checkpoint_seconds() const { return checkpoint_seconds_; }
  const Watch& watch() const { return watch_; }
  double wall_seconds() const { return wall_before_ + seconds_since(start_); }

  double discharged() const {
    double sum = 0;
    for (double d : discharged_by_outlet()) sum += d;
    return sum;
  }

  std::optional<SteadyFlow> steady() const {
    for (const StageRecord& r : state_.records) {
      if (r.kind != "drain") continue;
      const double end = r.end > r.start ? r.end : engine_->time();
      const OutputSettings& o = case_.output;
      return o.steady_to > 0 ? steady_flow_in(state_.samples, r.start + o.steady_from, r.start + o.steady_to)
                             : find_steady_flow(state_.samples, r.start, end, surge_time());
    }
    return std::nullopt;
  }

 private:
  // What gushes out when a lid opens is over in about the time that gravity has for the domain's height, s.
  double surge_time() const {
    const double g = norm(case_.gravity);
    return g > 0 ? std::sqrt(std::abs(dot(case_.domain.max - case_.domain.min, case_.gravity)) / (g * g)) : 0;
  }

  // False: the stage had begun before the checkpoint that the run was resumed from.
  bool begin(const std::string& name, const std::string& kind) {
    const bool anew = !state_.begun;
    if (anew) {
      state_.records.push_back({name.empty() ? kind : name, kind, engine_->time(), 0, 0});
      state_.stage_step = engine_->counters().steps;
      state_.begun = true;
    }
    progress_.begin(record().name);
    log_->info("stage '{}' ({}) {} at t = {:.6g} s with {} particles", record().name, kind, anew ? "begins" : "goes on",
               engine_->time(), engine_->count());
    return anew;
  }
  const StageRecord& record() const { return state_.records.back(); }
  double stage_time() const { return engine_->time() - record().start; }
  uint64_t stage_stream() const { return state_.stage + 1; }  // of random numbers

  void heed_stop() {
    if (!options_.stop || !*options_.stop) return;
    keep_watch(true);
    throw Interrupted{};
  }

  // `must`: before a state is kept that the run may go on from.
  void keep_watch(bool must) {
    for (const std::string& warning : watch_.look(*engine_, must)) log_->warn(warning);
  }

  // Steps until done() says so, which it is asked every few steps. share() is for the progress line. Between two steps,
  // and before done() is asked, the state is complete: what is written there goes on at the top of this loop.
  template <class Done, class Share>
  void advance_until(const Done& done, const Share& share) {
    for (;;) {
      heed_stop();
      if ((engine_->counters().steps - state_.stage_step) % kStepsPerLook == 0) {
        const bool due = seconds_since(last_checkpoint_) >= case_.checkpoint.interval;
        keep_watch(due);  // before a pour's next particles
        if (due) write_checkpoint();
        if (done()) return;
        progress_.update(engine_->time(), engine_->count(), static_cast<double>(engine_->counters().particle_steps),
                         share());
        log_now_and_then();
      }
      engine_->step();
      if (engine_->counters().steps % steps_per_sample_ == 0) sample();
      if (engine_->counters().steps >= next_look_) let_observers_look();
    }
  }

  RunView view() const { return {case_, *engine_, solid_, record().name, record().start, options_.out, *log_}; }

  void plan_looks() {
    next_look_ = Schedule::kNever;
    for (const auto& o : observers_) next_look_ = std::min(next_look_, o->schedule().after(engine_->counters().steps));
  }
  void let_observers_look() {
    const uint64_t step = engine_->counters().steps;
    for (const auto& o : observers_)
      if (o->schedule().after(step - 1) == step) o->look(view());
    plan_looks();
  }

  void run_stage(const std::string& name, const FillStage& s) {
    begin(name, "fill");
    const std::vector<ParticleState> placed =
        fill(case_, s, solid_, engine_->particles(), stage_stream(), [&](const FillProgress& so_far) {
          heed_stop();
          progress_.update(so_far);
        });
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
    if (begin(name, "pour")) make_pour(s), state_.pouring = {};
    Pour& pour = *pour_;
    double &next = state_.pouring.next, &last_placed = state_.pouring.last_placed;
    const auto due = [&] {
      if (stage_time() < next) return pour.done();
      const std::vector<ParticleState> placed = pour.batch(stage_time(), engine_->particles());
      if (!placed.empty()) last_placed = stage_time();
      if (stage_time() - last_placed > std::max(0.2, 20 * pour.batch_interval()) && !pour.done())
        throw RunError(
            fmt::format("stage '{}': the region '{}' has been full for {:.3g} s after {:.4g} kg: lower the rate or the "
                        "mass, or pour from higher up",
                        record().name, case_.regions[s.region].name, stage_time() - last_placed, pour.mass()));
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
      const double energy = engine_->sum(kinetic_energy);
      return energy / static_cast<double>(engine_->count()) <= s.kinetic_energy_per_particle;
    };
    advance_until(at_rest, [&] { return s.max_time > 0 ? stage_time() / s.max_time : -1.0; });
    if (s.kinetic_energy_per_particle > 0 && s.max_time > 0 && stage_time() >= s.max_time)
      log_->warn("stage '{}' ended by its longest time {} s, not at rest", record().name, s.max_time);
  }

  void run_stage(const std::string& name, const OpenStage& s) {
    begin(name, "open");
    engine_->open_walls(walls_of(s));
    take_out(walls_of(s));
  }

  void run_stage(const std::string& name, const DrainStage& s) {
    RunState::Draining& d = state_.draining;
    if (begin(name, "drain")) {
      d.present = engine_->sum([](const ParticleState& p) { return p.mass; });
      d.before = d.last_mass = discharged(), d.last_change = 0;
    }
    const auto drained = [&] { return d.present > 0 ? (discharged() - d.before) / d.present : 1.0; };
    const auto over = [&] {
      if (s.max_time > 0 && stage_time() >= s.max_time * (1 - 1e-9)) return true;
      if (engine_->count() == 0) return true;
      if (s.discharged_fraction > 0 && drained() >= s.discharged_fraction) return true;
      if (const double now = discharged(); now > d.last_mass) d.last_mass = now, d.last_change = stage_time();
      return s.no_flow_time > 0 && d.last_mass > d.before && stage_time() - d.last_change >= s.no_flow_time;
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

  // Opens the tables and writes the rows that there are already.
  void open_tables() {
    flow_csv_ = std::make_unique<CsvWriter>(options_.out / "mass_flow.csv",
                                            std::vector<std::string>{"time_s", "discharged_kg", "mass_flow_kg_per_s"});
    for (size_t k = 0; k < state_.samples.size(); ++k) write_flow_row(k);
    if (case_.meters.empty()) return;
    std::vector<std::string> columns{"time_s"};
    for (const Meter& m : case_.meters) columns.push_back(m.name + "_kg");
    meters_csv_ = std::make_unique<CsvWriter>(options_.out / "meters.csv", columns);
    for (size_t k = 0; k < state_.meter_rows.size(); k += columns.size())
      meters_csv_->row(std::span(state_.meter_rows).subspan(k, columns.size()));
  }

  void write_flow_row(size_t k) {
    const FlowSample& now = state_.samples[k];
    double rate = 0;
    if (k > 0) {
      const FlowSample& last = state_.samples[k - 1];
      rate = (now.total() - last.total()) / (now.time - last.time);
    }
    flow_csv_->row(std::array{now.time, now.total(), rate});
  }

  void sample() {
    if (!state_.samples.empty() && state_.samples.back().time >= engine_->time()) return;
    state_.samples.push_back({engine_->time(), discharged_by_outlet()});
    write_flow_row(state_.samples.size() - 1);
    if (!meters_csv_) return;
    std::vector<double> row{engine_->time()};
    for (const Meter& m : case_.meters)
      row.push_back(engine_->sum([&](const ParticleState& p) {
        const Vec3& x = p.position;
        return x.x >= m.min.x && x.x <= m.max.x && x.y >= m.min.y && x.y <= m.max.y && x.z >= m.min.z && x.z <= m.max.z
                   ? p.mass
                   : 0.0;
      }));
    state_.meter_rows.insert(state_.meter_rows.end(), row.begin(), row.end());
    meters_csv_->row(row);
  }

  Pour& make_pour(const PourStage& s) { return *(pour_ = std::make_unique<Pour>(case_, s, solid_, stage_stream())); }

  std::vector<uint32_t> walls_of(const OpenStage& s) const {
    std::vector<uint32_t> walls;
    for (uint32_t k = 0; k < solid_.walls.size(); ++k)
      if (std::find(s.walls.begin(), s.walls.end(), solid_.walls[k]) != s.walls.end()) walls.push_back(k);
    return walls;
  }
  void take_out(const std::vector<uint32_t>& walls) {
    std::erase_if(solid_.primitives,
                  [&](const Primitive& p) { return std::find(walls.begin(), walls.end(), p.wall) != walls.end(); });
  }

  Checkpoints::Save saver(const std::string& failure) {
    state_.wall_seconds = wall_seconds();
    return [this, failure](StateWriter& out) {
      out.save("head", head_of(case_, failure));
      out.save("run", state_);
      engine_->save(out);
      if (pour_) out.save("pour", *pour_);
      for (const auto& o : observers_) o->save(out, "observers/" + o->name());
    };
  }
  void note(const Checkpoints::Written& w) {
    ++checkpoints_written_, checkpoint_seconds_ += w.seconds;
    log_->info("checkpoint {} written at t = {:.6g} s ({:.1f} MB, {:.2f} s)", w.name, engine_->time(),
               static_cast<double>(w.bytes) / 1e6, w.seconds);
  }

  void log_now_and_then() {
    if (seconds_since(last_log_) < 10) return;
    last_log_ = Clock::now();
    const EngineCounters& k = engine_->counters();
    log_->info("t = {:.6g} s  {} particles  {:.3g} m/s at most  {} steps  {} rebuilds  skin {:.3g} m", engine_->time(),
               engine_->count(), engine_->max_speed(), k.steps, k.rebuilds, engine_->skin());
  }

  const Case& case_;
  const RunOptions& options_;
  std::shared_ptr<spdlog::logger> log_;
  Solid solid_;  // with the walls that are still there
  std::unique_ptr<Engine> engine_;
  Watch watch_;
  Progress progress_;
  std::unique_ptr<CsvWriter> flow_csv_, meters_csv_;
  std::unique_ptr<Pour> pour_;  // while one goes on
  uint64_t steps_per_sample_ = 1;
  RunState state_;
  std::vector<std::unique_ptr<Observer>> observers_;
  uint64_t next_look_ = Schedule::kNever;
  Checkpoints checkpoints_;
  std::string resumed_from_;
  int checkpoints_written_ = 0;
  double checkpoint_seconds_ = 0, wall_before_ = 0;
  Clock::time_point start_ = Clock::now(), last_log_ = start_, last_checkpoint_ = start_;
};

}  // namespace scree
