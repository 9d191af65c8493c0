// What a rebuild is made of: the sort, and the search for fibres near a grain.
#include <atomic>

#include "bench/measure.h"
#include "bench/scenes.h"
#include "geometry/bounds.h"
#include "geometry/solid_index.h"
#include "kernels/parallel.h"
#include "kernels/radix_sort.h"
#include "runtime/random.h"

namespace scree::bench {
namespace {

constexpr double kSkin = 0.2 * kDiameter;

// Random codes as long as those of the particles' cells; particles that are nearly in order sort no faster.
void radix_sort_keys(benchmark::State& state) {
  const size_t count = static_cast<size_t>(state.range(0));
  constexpr int bits = 30;
  set_thread_count(static_cast<int>(state.range(1)));
  Random random(1, 2);
  std::vector<uint64_t> keys(count), packed, scratch;
  for (size_t k = 0; k < count; ++k) keys[k] = (random.bits() >> (64 - bits)) << 32 | k;
  for (auto _ : state) {
    packed = keys;
    state.SetIterationTime(seconds_of([&] { radix_sort(packed, scratch, bits); }));
  }
  set_rate(state, "keys/s", static_cast<double>(count * state.iterations()));
  Hash hash;
  for (const uint64_t p : packed) hash.add(p);
  state.SetLabel(hash.text());
}

// The fibres and walls near random points of the paper's lattice: as grains inside it ask at a rebuild.
void fibre_query(benchmark::State& state) {
  const bool brute_force = state.range(0) != 0;
  set_thread_count(static_cast<int>(state.range(1)));
  const Case c = paper_hopper_case(Fibres::with);
  const auto index = brute_force ? make_brute_force_index(c.solid) : make_embree_index(c.solid);
  const Bounds& box = c.fibres.section;
  Random random(1, 3);
  std::vector<Vec3> points(brute_force ? 10000 : 500000);
  for (Vec3& x : points)
    x = {random.uniform(box.min.x, box.max.x), random.uniform(box.min.y, box.max.y),
         random.uniform(box.min.z, box.max.z)};
  std::atomic<uint64_t> near{0};
  for (auto _ : state)
    parallel_for_each(points.size(), [&](size_t k) {
      thread_local std::vector<uint32_t> found;
      found.clear();
      index->query(points[k], 0.5 * kDiameter + kSkin, found);
      near += found.size();
    });
  const double asked = static_cast<double>(points.size() * state.iterations());
  set_rate(state, "queries/s", asked);
  state.counters["found"] = static_cast<double>(near) / asked;
}

void register_all() {
  for (const int64_t threads : thread_counts()) {
    benchmark::RegisterBenchmark("radix_sort", radix_sort_keys)
        ->ArgNames({"keys", "threads"})
        ->Args({1000000, threads})
        ->UseManualTime()
        ->Iterations(10)
        ->Unit(benchmark::kMillisecond);
    for (const int64_t brute_force : {0, 1})
      benchmark::RegisterBenchmark("fibre_query", fibre_query)
          ->ArgNames({"brute_force", "threads"})
          ->Args({brute_force, threads})
          ->UseRealTime()
          ->Iterations(2)
          ->Unit(benchmark::kMillisecond);
  }
}

[[maybe_unused]] const bool kRegistered = (register_all(), true);

}  // namespace
}  // namespace scree::bench
