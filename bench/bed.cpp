// A settled bed: the step, and the list rebuild. Counters: particle-steps/s, contacts per particle, bytes held a
// particle; the label is the state hash, so that a fast wrong run shows.
#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include <fmt/format.h>

#include "bench/scenes.h"
#include "kernels/parallel.h"

namespace scree::bench {
namespace {

std::unique_ptr<Engine> engine_of(int tiles, const EngineOptions& options) {
  auto engine = make_engine(bed_case(tiles), options);
  engine->insert(settled_bed(tiles));
  for (int k = 0; k < 20; ++k) engine->step();
  return engine;
}

void report(benchmark::State& state, const Engine& engine, uint64_t particle_steps) {
  state.counters["particle_steps"] =
      benchmark::Counter(static_cast<double>(particle_steps), benchmark::Counter::kIsRate);
  state.counters["particles"] = static_cast<double>(engine.count());
  state.counters["coordination"] =
      2.0 * static_cast<double>(engine.touching_pairs().size()) / static_cast<double>(engine.count());
  state.counters["bytes_held"] = static_cast<double>(engine.bytes()) / static_cast<double>(engine.count());
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  state.counters["peak_rss_per_particle"] =
      static_cast<double>(usage.ru_maxrss) * 1024 / static_cast<double>(engine.count());
  state.SetLabel(fmt::format("{} {:016x}", engine.isa(), engine.state_hash()));
}

// Steps with a forced rebuild every `every` steps (0: when the engine wants one).
void settled_bed_step(benchmark::State& state) {
  const int tiles = static_cast<int>(state.range(0)), every = static_cast<int>(state.range(1));
  set_thread_count(static_cast<int>(state.range(2)));
  const auto engine = engine_of(tiles, {});
  const uint64_t before = engine->counters().particle_steps;
  for (auto _ : state) {
    for (int k = 0; k < 50; ++k) {
      if (every > 0 && k % every == 0) engine->insert({});  // invalidates the lists
      engine->step();
    }
  }
  report(state, *engine, engine->counters().particle_steps - before);
}

const long kThreads = thread_count();
BENCHMARK(settled_bed_step)
    ->ArgNames({"tiles", "rebuild_every", "threads"})
    ->Args({1, 50, kThreads})
    ->Args({3, 50, kThreads})
    ->Args({10, 50, kThreads})
    ->Args({10, 50, 1})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->MinTime(3);

}  // namespace
}  // namespace scree::bench

BENCHMARK_MAIN();
