// Grains into a run and out of it: filling a region, reading a CSV file, writing a VTP file, a checkpoint.
#include <filesystem>

#include "bench/measure.h"
#include "bench/scenes.h"
#include "bench/temporary.h"
#include "kernels/parallel.h"
#include "runtime/case_physics.h"
#include "runtime/checkpoint.h"
#include "runtime/csv_particles.h"
#include "runtime/placement.h"
#include "runtime/random.h"
#include "runtime/results.h"

namespace scree::bench {
namespace {

constexpr size_t kRows = 100000;

// A cube of grains at the solid fraction that poured beds start from.
void insertion(benchmark::State& state) {
  set_thread_count(static_cast<int>(state.range(1)));
  Case c = paper_case();
  Region box;
  FillStage stage;
  stage.regions = {0}, stage.mixture = {{0}, {1.0}}, stage.count = static_cast<uint64_t>(state.range(0));
  const double volume = sphere_mass(0.5 * kDiameter, 1) * static_cast<double>(stage.count) / stage.solid_fraction;
  const double side = 1.05 * std::cbrt(volume);  // grains stay off the faces by their radius
  box.max = {side, side, side};
  c.regions = {box};
  State grains;
  for (auto _ : state) grains = fill(c, stage, c.solid, {}, 1);
  set_rate(state, "grains/s", static_cast<double>(grains.size() * state.iterations()));
  Hash hash;
  for (const ParticleState& p : grains) hash.add(p.position);
  state.SetLabel(hash.text());
}

State random_grains() {
  Random random(1, 4);
  State grains(kRows);
  const auto vector = [&](double size) {
    return Vec3{random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
  };
  for (size_t k = 0; k < kRows; ++k) grains[k] = {vector(0.1), vector(0.5), vector(100), 2e-4, 1e-7, 0, k};
  return grains;
}

void csv_read(benchmark::State& state) {
  const TemporaryFile file(".csv");
  write_state_csv(file.path(), random_grains());
  std::vector<CsvParticle> read;
  for (auto _ : state) read = read_particles_csv(file.path().string());
  set_file_rates(state, file.path(), kRows);
  Hash hash;
  for (const CsvParticle& p : read) hash.add(p.position), hash.add(p.velocity);
  state.SetLabel(hash.text());
}

void vtp_write(benchmark::State& state) {
  const TemporaryFile file(".vtp");
  const State grains = random_grains();
  for (auto _ : state) write_particles_vtp(file.path(), grains);
  set_file_rates(state, file.path(), kRows);
}

// The engine's state of a settled bed, lists and histories included; forced to the disk, sealed, put in place.
void checkpoint_write(benchmark::State& state) {
  const int tiles = static_cast<int>(state.range(0));
  const Case c = bed_case(monodisperse(), tiles);
  const auto engine = started_engine(c, settled_bed(monodisperse(), tiles), kWarmUpSteps);
  const TemporaryFolder folder;
  const Checkpoints checkpoints(folder.path(), 1);
  std::string name;
  for (auto _ : state)
    name = checkpoints.write(engine->counters().steps, [&](StateWriter& out) { engine->save(out); }).name;
  const std::filesystem::path path = folder.path() / "checkpoints" / name;
  set_file_rates(state, path, engine->count());
  const auto again = make_engine(c);
  const double seconds = seconds_of([&] { Checkpoints::read(path, [&](StateReader& in) { again->load(in); }); });
  state.counters["read_seconds"] = seconds;
  if (again->state_hash() != engine->state_hash()) state.SkipWithError("what was read is not what was written");
  Hash hash;
  hash.add(engine->state_hash());
  state.SetLabel(hash.text());
}

void register_all() {
  for (const int64_t threads : thread_counts())
    benchmark::RegisterBenchmark("insertion", insertion)
        ->ArgNames({"grains", "threads"})
        ->Args({20000, threads})
        ->UseRealTime()
        ->Iterations(1)
        ->Unit(benchmark::kMillisecond);
  const auto file = [](const char* name, void (*run)(benchmark::State&)) {
    benchmark::RegisterBenchmark(name, run)->UseRealTime()->Iterations(5)->Unit(benchmark::kMillisecond);
  };
  file("csv_read", csv_read), file("vtp_write", vtp_write);
  for (const int64_t tiles : {3, 10, 31})
    benchmark::RegisterBenchmark("checkpoint_write", checkpoint_write)
        ->ArgNames({"tiles"})
        ->Args({tiles})
        ->UseRealTime()
        ->Iterations(3)
        ->Unit(benchmark::kMillisecond);
}

[[maybe_unused]] const bool kRegistered = (register_all(), true);

}  // namespace
}  // namespace scree::bench
