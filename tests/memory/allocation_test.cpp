// Memory that runs out at any allocation of a run: the run fails with a message, nothing is corrupted, nothing calls
// std::terminate, and what was written before is good to go on from. This program's own `operator new` fails when told.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "geometry/solid_index.h"
#include "kernels/parallel.h"
#include "tests/cases/every_stage.h"
#include "tests/oracle/beds.h"

namespace {

std::atomic<int64_t> countdown{-1};  // allocations until one fails; negative: none does
std::atomic<int64_t> allocations{0};
std::atomic<size_t> least{0};  // bytes: smaller ones neither count nor fail

void* allocate(size_t size, size_t alignment) {
  const bool counts = size >= least;
  allocations += counts;
  if (counts && countdown >= 0 && countdown-- == 0) throw std::bad_alloc();
  void* memory = alignment > 0 ? std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment)
                               : std::malloc(size > 0 ? size : 1);
  if (!memory) throw std::bad_alloc();
  return memory;
}

}  // namespace

// Replaced together; GCC sees one of a pair inlined and the other not.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"
#endif

void* operator new(size_t size) { return allocate(size, 0); }
void* operator new(size_t size, const std::nothrow_t&) noexcept try {
  return allocate(size, 0);
} catch (const std::bad_alloc&) {
  return nullptr;
}
void* operator new(size_t size, std::align_val_t alignment) { return allocate(size, static_cast<size_t>(alignment)); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, size_t, std::align_val_t) noexcept { std::free(memory); }

namespace scree {
namespace {

// Runs `body` once with each of its allocations failing in turn (each `stride`-th), then lets it pass. body() says
// whether it noticed.
template <class Body>
int fail_each_allocation(int64_t stride, const Body& body) {
  allocations = 0;
  EXPECT_FALSE(body()) << "without a failure";
  const int64_t all = allocations;
  EXPECT_GT(all, 10);
  int noticed = 0;
  for (int64_t k = 0; k < all; k += stride) {
    SCOPED_TRACE("allocation " + std::to_string(k));
    countdown = k;
    const bool seen = body();
    countdown = -1;
    noticed += seen;
    if (::testing::Test::HasFailure()) return noticed;
  }
  return noticed;
}

TEST(Memory, ThatRunsOutInAParallelLoopReachesTheCaller) {
  for (const int threads : {1, 3}) {
    set_thread_count(threads);
    std::vector<std::vector<int>> lists(64);
    const auto fill = [&] {
      for (auto& list : lists) std::vector<int>().swap(list);
      try {
        parallel_for(lists.size(), [&](size_t k) { lists[k].resize(100); });
      } catch (const std::bad_alloc&) {
        return true;
      }
      return false;
    };
    EXPECT_EQ(fail_each_allocation(1, fill), 64);
  }
}

TEST(Memory, ThatRunsOutInASearchIsNotHalfAnAnswer) {
  const Case c = [] {
    Case made = ceramic_case({{-0.01, -0.01, -0.02}, {0.01, 0.01, 0.02}});
    add_small_lattice(made);
    return made;
  }();
  const auto index = make_embree_index(c.solid);
  std::vector<uint32_t> all;
  index->query({0, 0, -0.005}, 0.003, all);
  ASSERT_GT(all.size(), 20u);
  const auto ask = [&] {
    std::vector<uint32_t> found;
    try {
      index->query({0, 0, -0.005}, 0.003, found);
    } catch (const std::bad_alloc&) {
      return true;
    }
    EXPECT_EQ(found, all);
    return false;
  };
  allocations = 0;
  ask();
  for (int64_t k = 0, most = allocations; k < most; ++k) {
    countdown = k;
    EXPECT_TRUE(ask()) << k;
    countdown = -1;
  }
}

// Steps, rebuilds, the solid's search: an engine in which an allocation failed is given up, but not with a crash.
TEST(Memory, ThatRunsOutInTheEngineIsAnException) {
  set_thread_count(2);
  const LooseBed bed{5, 5, 4};
  const Case c = bed_case(bed);
  EngineOptions searching_all;  // Embree has its own ways to say that memory ran out
  searching_all.brute_force_solid = true;
  const std::vector<ParticleState> particles = bed.particles({0, 0, 1e-5}, 1);
  const auto run = [&] {
    try {
      const auto engine = make_engine(c, searching_all);
      engine->insert(particles);
      for (int k = 0; k < 60; ++k) engine->step();
      engine->particles();
    } catch (const std::bad_alloc&) {
      return true;
    }
    return false;
  };
  EXPECT_GT(fail_each_allocation(1, run), 50);
}

// ---- allocations in passing

struct Allocated {
  int64_t by_steps = 0, by_rebuilds = 0;
};

// A bed at rest, `steps` steps without a rebuild and `rebuilds` of them forced: what operator new was asked for.
Allocated allocations_of_bed(int threads, int steps, int rebuilds) {
  set_thread_count(threads);
  const LooseBed bed{6, 6, 8, kRadius, kRadius, 2.2};
  const auto engine = make_engine(bed_case(bed), with_skin(0.4 * kRadius));
  engine->insert(bed.particles({0, 0, 0}, 17));
  run_steps(*engine, 8000);
  for (int k = 0; k < 3; ++k) engine->insert({}), engine->step();  // warm, with all lists as large as they will be
  Allocated result;
  const uint64_t before = engine->counters().rebuilds;
  allocations = 0;
  run_steps(*engine, steps);
  result.by_steps = allocations;
  EXPECT_EQ(engine->counters().rebuilds, before) << "the skin was used up";
  allocations = 0;
  for (int k = 0; k < rebuilds; ++k) engine->insert({}), engine->step();
  result.by_rebuilds = allocations;
  EXPECT_EQ(engine->counters().rebuilds, before + static_cast<uint64_t>(rebuilds));
  std::printf("%d threads: %lld allocations in %d steps, %lld in %d rebuilds\n", threads,
              static_cast<long long>(result.by_steps), steps, static_cast<long long>(result.by_rebuilds), rebuilds);
  return result;
}

// 288 grains are two chunks. A rebuild asks for two scratch arrays a chunk in gathering histories and for what finds
// the solid near its particles (which grows as it finds), and for a few of its own: 24 were seen, twice that are
// allowed.
TEST(Memory, IsNotAskedForInAStepOfAWarmBed) {
  for (const int threads : {1, 2}) {
    const Allocated a = allocations_of_bed(threads, 500, 10);
    EXPECT_EQ(a.by_steps, 0);
    EXPECT_LE(a.by_rebuilds, 10 * 48);
  }
}

// The bed slides down a slope for good: near pairs come and go, lists are renewed, now and then one grows beyond what
// it ever was. One such was seen in 2,950 steps, 25 allocations a rebuild of the two chunks.
TEST(Memory, IsHardlyAskedForInAStepOfAWarmFlow) {
  set_thread_count(2);
  const LooseBed bed{6, 6, 8, kRadius, kRadius, 2.2};
  Case c = bed_case(bed);
  c.gravity = {7, 0, -7};
  const auto engine = make_engine(c);
  engine->insert(bed.particles({0, 0, 0}, 17));
  run_steps(*engine, 12000);
  int64_t by_steps = 0, by_rebuilds = 0;
  const uint64_t before = engine->counters().rebuilds;
  for (int k = 0; k < 3000; ++k) {
    const uint64_t rebuilds = engine->counters().rebuilds;
    allocations = 0;
    engine->step();
    (engine->counters().rebuilds == rebuilds ? by_steps : by_rebuilds) += allocations;
  }
  const uint64_t rebuilds = engine->counters().rebuilds - before;
  std::printf("%lld allocations in steps of a flow at %.2g m/s, %lld in %llu rebuilds\n",
              static_cast<long long>(by_steps), engine->max_speed(), static_cast<long long>(by_rebuilds),
              static_cast<unsigned long long>(rebuilds));
  EXPECT_GT(rebuilds, 20u);
  EXPECT_LE(by_steps, 10);
  EXPECT_LE(by_rebuilds, static_cast<int64_t>(48 * rebuilds));
}

// A whole run through every stage, its checkpoints and results. Of a page or more: the destructors of nlohmann's JSON
// ask for a few bytes, and end the process where there are none.
TEST(Memory, ThatRunsOutInARunLeavesAStateToGoOnFrom) {
  set_thread_count(1);
  least = 4096;
  const TemporaryFolder folder;
  const Case c = read_case(write_every_stage(folder.path()),
                           {"stage.fill.count=20", "checkpoint.interval=1e-3", "checkpoint.keep=2"});
  int number = 0;
  std::string hash;
  const auto run = [&](const std::filesystem::path& out, bool resume) {
    RunOptions options;
    options.out = out, options.threads = 1, options.resume = resume;
    options.engine.brute_force_solid = true;
    return run_case(c, options);
  };
  const auto run_and_resume = [&](int64_t allocation_that_fails) {
    const std::filesystem::path out = folder.path() / ("run_" + std::to_string(number++));
    countdown = allocation_that_fails;
    bool noticed = false;
    try {
      const RunResult result = run(out, false);
      noticed = result.status == RunStatus::failed;
      if (noticed) {
        EXPECT_NE(result.message.find("memory"), std::string::npos) << result.message;
      }
    } catch (const std::bad_alloc&) {  // before the run began, or in saying what happened
      noticed = true;
    }
    countdown = -1;
    if (noticed && !Checkpoints(out, 2).newest_first().empty()) {
      EXPECT_EQ(run(out, true).status, RunStatus::done);
    }
    if (!noticed || !Checkpoints(out, 2).newest_first().empty()) {
      const std::string now = read_summary(out)["state_hash"];
      if (hash.empty()) hash = now;
      EXPECT_EQ(now, hash);
    }
    std::filesystem::remove_all(out);
    return noticed;
  };
  allocations = 0;
  EXPECT_FALSE(run_and_resume(-1));
  const int64_t all = allocations;
  int noticed = 0, tried = 0;
  for (int64_t k = 0; k < all && !HasFailure(); k += 1 + all / 60, ++tried) {
    SCOPED_TRACE("allocation " + std::to_string(k) + " of " + std::to_string(all));
    noticed += run_and_resume(k);
  }
  least = 0;
  EXPECT_GT(noticed, tried / 2);
}

}  // namespace
}  // namespace scree
