// What the benchmarks measure with: the copy that bandwidth is held against, hashes, the counters of timed steps.
#pragma once

#include <benchmark/benchmark.h>

#include <bit>
#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "runtime/engine.h"

namespace scree::bench {

inline constexpr int kStepsPerIteration = 50;
inline constexpr int kWarmUpSteps = 20;  // histories of the first contacts grow, caches and lists are filled

// Bytes read and written a second by all threads copying arrays too large for the caches: the best of a few copies.
double copy_bandwidth();

// Thread counts worth comparing here: all processors, and one.
std::vector<int64_t> thread_counts();

// Times kStepsPerIteration steps an iteration; the lists are rebuilt by force every `rebuild_every` steps (0: when the
// engine wants to). The counters, and a label of instruction set and state hash, so that a fast wrong run shows.
// Benchmarks fix their iterations: the hash then depends on nothing but the program.
void time_steps(benchmark::State& state, Engine& engine, int rebuild_every);

void set_rate(benchmark::State& state, const std::string& what, double amount);  // amount per timed second
// Of a file of so many rows, written or read once an iteration.
void set_file_rates(benchmark::State& state, const std::filesystem::path& path, size_t rows);

class Hash {
 public:
  void add(uint64_t word) { value_ = (std::rotl(value_, 5) ^ word) * 0x9e3779b97f4a7c15ull; }
  void add(double x) { add(std::bit_cast<uint64_t>(x)); }
  void add(const Vec3& v) { add(v.x), add(v.y), add(v.z); }
  std::string text() const;

 private:
  uint64_t value_ = 0;
};

template <class Work>
double seconds_of(const Work& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace scree::bench
