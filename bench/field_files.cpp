// Frames of field files: all fields of the grains of the small lattice in flow.
#include "runtime/field_files.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <spdlog/logger.h>

#include "bench/measure.h"
#include "bench/scenes.h"
#include "bench/temporary.h"
#include "kernels/parallel.h"
#include "runtime/particle_fields.h"

namespace scree::bench {
namespace {

// The run's part of a frame.
void field_copy(benchmark::State& state) {
  set_thread_count(static_cast<int>(state.range(0)));
  const Case c = drain_case();
  const auto engine = started_engine(c, drain_in_flow(), kWarmUpSteps);
  for (auto _ : state) packed_particles(ParticleSnapshot(c, *engine, particle_field_names()));
  set_rate(state, "rows/s", static_cast<double>(engine->count() * state.iterations()));
}

// What the thread beside the run does with it, but for the disk.
void field_write(benchmark::State& state) {
  const Case c = drain_case();
  const auto engine = started_engine(c, drain_in_flow(), kWarmUpSteps);
  const auto frame = packed_particles(c, *engine, particle_field_names());
  const TemporaryFile to(".vtkhdf");
  for (auto _ : state) {
    VtkHdfFile file(to.path(), VtkHdfType::unstructured_grid);
    for (const PackedArray& array : frame) file.array(array);
    file.close();
  }
  set_file_rates(state, to.path(), engine->count());
}

// 200 frames in the 69,250 steps of cases/olhx/demo.toml; its drain has 49,250 of them.
constexpr int kBlockSteps = 346, kFours = 35;

// Seconds of a block of steps, with a frame of all fields at its beginning or without.
class Blocks {
 public:
  Blocks() : case_(demo_case()), engine_(started_engine(case_, demo_charged(), kWarmUpSteps)) {
    case_.output.fields.write = particle_field_names();
  }
  double without() {
    return seconds_of([&] {
      for (int k = 0; k < kBlockSteps; ++k) engine_->step();
    });
  }
  double with() {
    return seconds_of([&] { files_.look(view_); }) + without();
  }
  uint64_t state_hash() const { return engine_->state_hash(); }
  // Seconds of the run, the writing in it included, and of all writing, a frame.
  std::pair<double, double> parts() {
    files_.finish(view_);
    const nlohmann::json told = files_.summary();
    const double frames = told["frames"];
    return {told["seconds_in_run"].get<double>() / frames, told["seconds_of_writing"].get<double>() / frames};
  }

 private:
  TemporaryFolder folder_;
  Case case_;
  std::unique_ptr<Engine> engine_;
  // A frame is written while the next is packed, as at the demo's pace: never in a block without.
  FieldFiles files_{case_, folder_.path(), engine_->dt(), std::chrono::hours{1}};
  std::string stage_ = "drain";
  spdlog::logger log_{"bench"};
  RunView view_{case_, *engine_, case_.solid, stage_, 0, folder_.path(), log_};
};

double mean(const std::vector<double>& x) { return std::accumulate(x.begin(), x.end(), 0.0) / std::ssize(x); }

double quantile(std::vector<double> x, double share) {
  std::ranges::sort(x);
  return x[static_cast<size_t>(share * static_cast<double>(x.size() - 1) + 0.5)];
}

// Of the median, from the quartiles: a machine that stops for a moment counts once, however long.
double standard_error(const std::vector<double>& x) {
  constexpr double kSigmas = 1.349, kOfMedian = 1.2533;  // between the quartiles; against the mean's (normal numbers)
  return kOfMedian * (quantile(x, 0.75) - quantile(x, 0.25)) / kSigmas / std::sqrt(static_cast<double>(x.size()));
}

// What a frame costs a run in all: in the run and by the thread beside it, which takes a core from the loops. The
// demo's drain, in blocks of steps without, with, with, without a frame: a machine that drifts does so to both. The
// time is the median difference within such fours; its error and its share of a block are counters.
void field_frame_in_run(benchmark::State& state) {
  constexpr int kRuns = 3;
  set_thread_count(static_cast<int>(state.range(0)));
  demo_charged();  // is made the first time it is asked for
  for (auto _ : state) {
    std::vector<double> cost, plain, in_run, writing;  // s
    Hash hash;
    for (int run = 0; run < kRuns; ++run) {
      Blocks blocks;
      for (int four = 0; four < kFours; ++four) {
        const double first = blocks.without(), second = blocks.with(), third = blocks.with(), last = blocks.without();
        cost.push_back(0.5 * (second + third - first - last)), plain.push_back(0.5 * (first + last));
      }
      hash.add(blocks.state_hash());
      const auto [run_seconds, writing_seconds] = blocks.parts();
      in_run.push_back(run_seconds), writing.push_back(writing_seconds);
    }
    const double frame = quantile(cost, 0.5), block = quantile(plain, 0.5);
    state.SetIterationTime(frame);
    state.counters["frame_error_ms"] = 1e3 * standard_error(cost);
    state.counters["frame_in_run_ms"] = 1e3 * mean(in_run);
    state.counters["frame_writing_ms"] = 1e3 * mean(writing);
    state.counters["block_ms"] = 1e3 * block;
    state.counters["share"] = frame / block;
    state.counters["share_error"] = standard_error(cost) / block;
    state.SetLabel(hash.text());
  }
}

void register_all() {
  for (const int64_t threads : thread_counts()) {
    benchmark::RegisterBenchmark("field_copy", field_copy)
        ->ArgNames({"threads"})
        ->Args({threads})
        ->UseRealTime()
        ->Iterations(50)
        ->Unit(benchmark::kMillisecond);
    benchmark::RegisterBenchmark("field_frame_in_run", field_frame_in_run)
        ->ArgNames({"threads"})
        ->Args({threads})
        ->UseManualTime()
        ->Iterations(1)
        ->Unit(benchmark::kMillisecond);
  }
  benchmark::RegisterBenchmark("field_write", field_write)
      ->UseRealTime()
      ->Iterations(20)
      ->Unit(benchmark::kMillisecond);
}

[[maybe_unused]] const bool kRegistered = (register_all(), true);

}  // namespace
}  // namespace scree::bench
