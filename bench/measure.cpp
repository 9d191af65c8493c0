#include "bench/measure.h"

#include <sys/resource.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <string>

#include <fmt/format.h>

#include "kernels/parallel.h"

#if defined(__GLIBC__)  // known once a header of the standard library was read
#include <malloc.h>
#endif

namespace scree::bench {
namespace {

// Bytes, of what the system says of this process; 0 where it does not say.
double memory_now(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (double kilobytes = 0; word == key + ":" && status >> kilobytes) return 1024 * kilobytes;
  return 0;
}

// From here on the peak is counted anew. False where that cannot be done: not Linux, or not allowed.
bool reset_peak() {
#if defined(__GLIBC__)
  malloc_trim(0);  // what was freed before does not count
#endif
  std::ofstream file("/proc/self/clear_refs");
  return static_cast<bool>(file << 5 << std::flush);
}

// The most that the process holds during steps with forced rebuilds, a particle: everything, the program itself too.
// Taken after the timing and the hash.
void report_peak_of_rebuilds(benchmark::State& state, Engine& engine) {
  if (!reset_peak()) return;
  const double count = static_cast<double>(engine.count());
  state.counters["memory_before_rebuild_per_particle"] = memory_now("VmRSS") / count;
  for (int k = 0; k < 3; ++k) engine.insert({}), engine.step(), engine.step();
  state.counters["peak_of_rebuild_per_particle"] = memory_now("VmHWM") / count;
}

double peak_memory() {  // bytes, of the process so far
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024;
}

void report_steps(benchmark::State& state, const Engine& engine, uint64_t particle_steps, uint64_t steps, double copy) {
  const double count = static_cast<double>(engine.count()), done = static_cast<double>(particle_steps);
  const double contacts = static_cast<double>(engine.touching_pairs().size());
  const double traffic = static_cast<double>(engine.step_traffic()) / count;
  set_rate(state, "particle_steps/s", done);
  set_rate(state, "contacts/s", contacts * static_cast<double>(steps));
  set_rate(state, "copy_share", done * traffic / copy);
  state.counters["particles"] = count;
  state.counters["coordination"] = 2 * contacts / count;
  state.counters["bytes_per_particle_step"] = traffic;
  state.counters["copy_bytes/s"] = copy;
  state.counters["bytes_held_per_particle"] = static_cast<double>(engine.bytes()) / count;
  state.counters["peak_memory_per_particle"] = peak_memory() / count;
  state.SetLabel(fmt::format("{} {:016x}", engine.isa(), engine.state_hash()));
}

}  // namespace

double copy_bandwidth() {
  constexpr size_t size = size_t{128} << 20, piece = size_t{1} << 20;
  const auto from = std::make_unique_for_overwrite<char[]>(size), to = std::make_unique_for_overwrite<char[]>(size);
  parallel_for(size / piece, [&](size_t k) {  // pages belong to the thread that touches them first
    std::memset(from.get() + k * piece, 1, piece), std::memset(to.get() + k * piece, 0, piece);
  });
  double best = 1e30;
  for (int round = 0; round < 5; ++round)
    best = std::min(best, seconds_of([&] {
                      parallel_for(size / piece,
                                   [&](size_t k) { std::memcpy(to.get() + k * piece, from.get() + k * piece, piece); });
                    }));
  benchmark::DoNotOptimize(to.get());
  return 2.0 * size / best;
}

std::vector<int64_t> thread_counts() {
  static const int64_t all = thread_count();  // before a benchmark sets it
  return all > 1 ? std::vector<int64_t>{all, 1} : std::vector<int64_t>{1};
}

void time_steps(benchmark::State& state, Engine& engine, int rebuild_every) {
  const double copy = copy_bandwidth();
  const uint64_t before = engine.counters().particle_steps, steps_before = engine.counters().steps;
  for (auto _ : state)
    for (int k = 0; k < kStepsPerIteration; ++k) {
      if (rebuild_every > 0 && k % rebuild_every == 0) engine.insert({});  // invalidates the lists
      engine.step();
    }
  report_steps(state, engine, engine.counters().particle_steps - before, engine.counters().steps - steps_before, copy);
  if (rebuild_every > 0) report_peak_of_rebuilds(state, engine);
}

void set_rate(benchmark::State& state, const std::string& what, double amount) {
  state.counters[what] = benchmark::Counter(amount, benchmark::Counter::kIsRate);
}

void set_file_rates(benchmark::State& state, const std::filesystem::path& path, size_t rows) {
  set_rate(state, "rows/s", static_cast<double>(rows * state.iterations()));
  set_rate(state, "file_bytes/s", static_cast<double>(file_size(path) * state.iterations()));
}

std::string Hash::text() const { return fmt::format("{:016x}", value_); }

}  // namespace scree::bench
