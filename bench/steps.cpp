// The step, everything included, in the scenes that matter: settled beds of several sizes, a polydisperse bed, the
// small lattice in flow, the paper's hopper discharging; and the list rebuild alone.
#include "bench/measure.h"
#include "bench/scenes.h"
#include "kernels/parallel.h"

namespace scree::bench {
namespace {

constexpr int kRebuildEvery = 50;

// Two iterations are 100 steps. Small beds take more of them: 20 ms cannot be timed.
int iterations_of(int64_t tiles) { return tiles == 1 ? 100 : tiles < 10 ? 20 : 2; }

void time_bed(benchmark::State& state, const Bed& bed) {
  const int tiles = static_cast<int>(state.range(0));
  set_thread_count(static_cast<int>(state.range(1)));
  const auto engine = started_engine(bed_case(bed, tiles), settled_bed(bed, tiles), kWarmUpSteps);
  time_steps(state, *engine, kRebuildEvery);
}

void settled_bed_step(benchmark::State& state) { time_bed(state, monodisperse()); }
void polydisperse_bed_step(benchmark::State& state) { time_bed(state, polydisperse()); }

void lattice_drain_step(benchmark::State& state) {
  set_thread_count(static_cast<int>(state.range(0)));
  time_steps(state, *started_engine(drain_case(), drain_in_flow(), 10 * kWarmUpSteps), 0);
}

void hopper_step(benchmark::State& state) {
  set_thread_count(static_cast<int>(state.range(0)));
  time_steps(state, *started_engine(open_hopper_case(), hopper_in_flow(), kWarmUpSteps), 0);
}

double rebuild_seconds(const EngineCounters& k) {
  return k.history_seconds + k.sort_seconds + k.pair_search_seconds + k.solid_search_seconds;
}

// Rebuilds alone, by the engine's own clock, one step between each two.
void time_rebuilds(benchmark::State& state, Engine& engine) {
  for (auto _ : state) {
    const double before = rebuild_seconds(engine.counters());
    engine.insert({});  // invalidates the lists
    engine.step();
    state.SetIterationTime(rebuild_seconds(engine.counters()) - before);
  }
  set_rate(state, "particles/s", static_cast<double>(engine.count() * state.iterations()));
  state.counters["particles"] = static_cast<double>(engine.count());
  Hash hash;
  hash.add(engine.state_hash());
  state.SetLabel(engine.isa() + " " + hash.text());
}

void rebuild_bed(benchmark::State& state) {
  const int tiles = static_cast<int>(state.range(0));
  set_thread_count(static_cast<int>(state.range(1)));
  time_rebuilds(state,
                *started_engine(bed_case(monodisperse(), tiles), settled_bed(monodisperse(), tiles), kWarmUpSteps));
}

// About a million grains in the full lattice and above it: once with its 1,460 fibres, once the same grains without.
void rebuild_lattice(benchmark::State& state) {
  set_thread_count(static_cast<int>(state.range(1)));
  const State grains = stacked_grains(paper_hopper_case(Fibres::with), 0, 145e-3);
  const Case c = paper_hopper_case(state.range(0) != 0 ? Fibres::with : Fibres::without);
  time_rebuilds(state, *started_engine(c, grains, 1));
}

void register_all() {
  const auto step = [](const char* name, void (*run)(benchmark::State&)) {
    return benchmark::RegisterBenchmark(name, run)->Unit(benchmark::kMillisecond)->UseRealTime();
  };
  const auto alone = [](const char* name, void (*run)(benchmark::State&)) {
    return benchmark::RegisterBenchmark(name, run)->Unit(benchmark::kMillisecond)->UseManualTime()->Iterations(5);
  };
  for (const int64_t threads : thread_counts()) {
    for (const int64_t tiles : {1, 3, 10, 20, 31})
      step("settled_bed", settled_bed_step)
          ->ArgNames({"tiles", "threads"})
          ->Args({tiles, threads})
          ->Iterations(iterations_of(tiles));
    for (const int64_t tiles : {1, 3, 10})
      step("polydisperse_bed", polydisperse_bed_step)
          ->ArgNames({"tiles", "threads"})
          ->Args({tiles, threads})
          ->Iterations(iterations_of(tiles));
    step("lattice_drain", lattice_drain_step)->ArgNames({"threads"})->Args({threads})->Iterations(20);
    step("hopper", hopper_step)->ArgNames({"threads"})->Args({threads})->Iterations(10);
    alone("rebuild_bed", rebuild_bed)->ArgNames({"tiles", "threads"})->Args({3, threads});
    alone("rebuild_bed", rebuild_bed)->ArgNames({"tiles", "threads"})->Args({10, threads});
    for (const int64_t fibres : {0, 1})
      alone("rebuild_lattice", rebuild_lattice)->ArgNames({"fibres", "threads"})->Args({fibres, threads});
  }
}

[[maybe_unused]] const bool kRegistered = (register_all(), true);

}  // namespace
}  // namespace scree::bench
