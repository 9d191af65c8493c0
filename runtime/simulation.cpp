#include "runtime/simulation.h"

#include <sys/resource.h>

#include <fmt/format.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <nlohmann/json.hpp>

#include "kernels/parallel.h"
#include "runtime/case_size.h"
#include "runtime/case_writer.h"
#include "runtime/energy_balance.h"
#include "runtime/memory.h"
#include "runtime/profile.h"
#include "runtime/run_folder.h"
#include "runtime/stages.h"
#include "runtime/time_scales.h"

namespace scree {

namespace {

constexpr double kFailureReach = 10;  // radii of the largest particle: what failure.vtp shows round a failure

constexpr const char* kOutOfMemory =
    "out of memory: run fewer particles, or on a machine with more; `scree check` prints what a case needs";

const char* text(RunStatus s) {
  return s == RunStatus::done ? "done" : s == RunStatus::interrupted ? "interrupted" : "failed";
}

nlohmann::json summary_of(const Case& c, const Simulation& simulation, const RunResult& result) {
  const double wall = simulation.wall_seconds();
  const Engine& e = simulation.engine();
  const EngineCounters& k = e.counters();
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  nlohmann::json j;
  j["title"] = c.title, j["case"] = simulation.state().source, j["status"] = text(result.status);
  if (!result.message.empty()) j["message"] = result.message;
  if (!result.warning.empty()) j["warning"] = result.warning;
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
  for (const StageRecord& r : simulation.state().records)
    j["stages"].push_back({{"name", r.name},
                           {"kind", r.kind},
                           {"start_s", r.start},
                           {"end_s", std::max(r.start, r.end)},
                           {"particles", r.particles}});
  j["checkpoints"] = {{"written", simulation.checkpoints_written()}, {"seconds", simulation.checkpoint_seconds()}};
  j["resumed_from"] = simulation.resumed_from().empty() ? nlohmann::json() : nlohmann::json(simulation.resumed_from());
  j["energy_watch"] = {{"looks", simulation.watch().energy_looks()},
                       {"largest_share_of_bound", simulation.watch().largest_energy_share()}};
  if (c.output.energy_ledger) j["energy"] = to_json(balance_of(e, c));
  for (const auto& o : simulation.observers())
    if (const nlohmann::json own = o->summary(); !own.is_null()) j[o->name()] = own;
  j["wall_seconds"] = {{"step", k.step_seconds},
                       {"history", k.history_seconds},
                       {"sort", k.sort_seconds},
                       {"pair_search", k.pair_search_seconds},
                       {"solid_search", k.solid_search_seconds}};
  return j;
}

std::shared_ptr<spdlog::logger> make_log(const std::filesystem::path& out, bool anew) {
  try {
    auto log = std::make_shared<spdlog::logger>(
        "scree", std::make_shared<spdlog::sinks::basic_file_sink_mt>((out / "run.log").string(), anew));
    log->set_pattern("%Y-%m-%d %H:%M:%S.%e %l %v");
    log->flush_on(spdlog::level::info);
    return log;
  } catch (const spdlog::spdlog_ex& e) {
    throw RunError(e.what());
  }
}

// A file that a stage reads is wrong.
struct BadInput : RunError {
  using RunError::RunError;
};

// Writes a checkpoint after a failure; what keeps it from being written is added to the failure.
template <class Failure, class Write>
void leave_checkpoint(const char* why, const Write& write) {
  try {
    write();
  } catch (const CheckpointError& e) {
    throw Failure(fmt::format("{}; and {}", why, e.what()));
  }
}

// Whatever ends the run, its state stays behind: complete where it was interrupted or a stage could not begin, as it is
// where it failed. Memory that ran out leaves half a step, which shows nothing: there the checkpoint before counts.
void run_or_leave_a_checkpoint(Simulation& simulation) {
  const auto leave_failed = [&](const char* why) {
    leave_checkpoint<RunError>(why, [&] { simulation.write_failed_checkpoint(why); });
  };
  try {
    simulation.run();
  } catch (const Interrupted&) {
    simulation.write_checkpoint();
    throw;
  } catch (const CheckpointError&) {
    throw;
  } catch (const RunError& failure) {
    leave_failed(failure.what());
    throw;
  } catch (const CaseError& e) {  // of a read stage, before it inserts: resumed when the file is mended
    leave_checkpoint<BadInput>(e.what(), [&] { simulation.write_checkpoint(); });
    throw BadInput(e.what());
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& failure) {  // of a library: nothing that a run expects
    leave_failed(failure.what());
    throw RunError(failure.what());
  }
}

// What a failure before the run was gone on with left to be looked at: of no use once it is done, or failed otherwise.
void remove_earlier_failure(RunStatus now, const Case& c, const std::filesystem::path& out) {
  if (now == RunStatus::interrupted) return;
  std::error_code ignored;
  std::filesystem::remove(out / "failure.vtp", ignored);
  if (now == RunStatus::done) Checkpoints(out, c.checkpoint.keep).remove_failed();
}

// The simulation as the newest usable checkpoint has it; nothing if the run died before its first. A refused
// checkpoint is named, with the reason, and the one before it is tried.
std::unique_ptr<Simulation> resumed(const Case& c, const RunOptions& options,
                                    const std::shared_ptr<spdlog::logger>& log) {
  const Checkpoints checkpoints(options.out, c.checkpoint.keep);
  const auto tell = [&](const std::string& text) {
    log->warn(text);
    if (options.tell) options.tell(text);
  };
  std::string refused;
  for (const std::filesystem::path& path : checkpoints.newest_first()) {
    auto simulation = std::make_unique<Simulation>(c, options, log);
    try {
      simulation->load(path);
    } catch (const CheckpointRefused& e) {
      tell(fmt::format("checkpoint {} is refused: {}", path.filename().string(), e.what()));
      refused += fmt::format("\n  {}: {}", path.filename().string(), e.what());
      continue;
    }
    checkpoints.set_aside_newer(path);
    tell(fmt::format("resumed from {} at t = {:.6g} s", path.filename().string(), simulation->engine().time()));
    return simulation;
  }
  if (!refused.empty())
    throw RunRefused(fmt::format(
        "no checkpoint in {} can be gone on from:{}\nGo on with the case as it was ({}), or start again in another "
        "folder.",
        (options.out / "checkpoints").string(), refused, (options.out / "case.toml").string()));
  if (std::filesystem::exists(options.out / "summary.json"))
    throw RunRefused(
        fmt::format("{} holds the results of a run, but no checkpoint to go on from: start again in another "
                    "folder",
                    options.out.string()));
  tell(fmt::format("{} holds no checkpoint yet: the run begins at its start", options.out.string()));
  return nullptr;
}

}  // namespace

RunResult run_case(const Case& c, const RunOptions& options) {
  if (!options.ignore_memory) require_memory(c);
  RunResult result;
  result.out = options.out;
  std::unique_ptr<Simulation> simulation;
  std::shared_ptr<spdlog::logger> log;
  std::optional<Vec3> failed_at;
  const auto fail = [&](const std::string& why) {
    result.status = RunStatus::failed, result.message = why;
    if (log) log->error(why);
  };
  std::optional<RunFolder> folder;
  try {
    take_stack();
    folder.emplace(options.out);
    log = make_log(options.out, !options.resume);
    if (options.threads > 0) set_thread_count(options.threads);
    if (options.resume) simulation = resumed(c, options, log);
    if (!simulation) {
      write_file(options.out / "case.toml", write_case(c));
      sync_file(options.out / "case.toml"), sync_folder(options.out);  // checkpoints are nothing without it
      log->info("{}", describe_case(c));
      for (const std::string& warning : time_step_warnings(c)) log->warn(warning);
      simulation = std::make_unique<Simulation>(c, options, log);
    }
    log->info("{} threads, {} kernels", thread_count(), simulation->engine().isa());
    run_or_leave_a_checkpoint(*simulation);
  } catch (const Interrupted&) {
    result.status = RunStatus::interrupted;
    log->warn("interrupted at t = {:.6g} s", simulation->engine().time());
  } catch (const BadInput& e) {
    fail(e.what());
    result.bad_input = true;
  } catch (const RunError& e) {
    fail(e.what());
    failed_at = e.where;
  } catch (const std::bad_alloc&) {
    fail(kOutOfMemory);
  }
  if (const auto good = Checkpoints(options.out, c.checkpoint.keep).newest_first(); !good.empty())
    result.checkpoint = good.front().string();
  if (!simulation) return result;
  try {
    result.steady = simulation->steady();
    if (const std::string why = simulation->finish_observers(); !why.empty())
      fail(result.message.empty() ? why : result.message + "; and " + why);
    if (options.engine.profile) {
      const EngineCounters& k = simulation->engine().counters();
      result.profile = profile_table(profile_of(k, thread_count(), simulation->wall_seconds()), k.particle_steps);
      log->info("where the time went:\n{}", result.profile);
    }
    if (c.output.energy_ledger) result.warning = complaint(balance_of(simulation->engine(), c));
    if (!result.warning.empty()) log->warn(result.warning);
    remove_earlier_failure(result.status, c, options.out);
    write_file(options.out / "summary.json", summary_of(c, *simulation, result).dump(2) + "\n");
    if (failed_at)
      write_neighbourhood_vtp(options.out / "failure.vtp", simulation->engine(), *failed_at,
                              kFailureReach * largest_radius(c));
    if (c.output.final_vtk) {
      const Engine& engine = simulation->engine();
      write_particles_vtp(options.out / "particles.vtp", engine.count(), [&](size_t k) { return engine.particle(k); });
    }
    log->info("{}", text(result.status));
  } catch (const std::bad_alloc&) {
    fail(result.message.empty() ? kOutOfMemory : result.message + "; and no memory is left for the results");
  } catch (const std::exception& e) {
    fail(result.message.empty() ? e.what() : result.message + "; and " + e.what());
  }
  return result;
}

}  // namespace scree
