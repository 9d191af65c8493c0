// Input that is absurd in its size: refused with the place and what is allowed, before it takes memory or time.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <new>
#include <numbers>

#include "runtime/case_reader.h"
#include "runtime/case_size.h"
#include "runtime/memory.h"
#include "runtime/simulation.h"
#include "tests/runtime/case_text.h"
#include "tests/shadow_memory.h"

namespace scree {
namespace {

using testing::Folder;

template <class Read>
std::string refusal(const Read& read) {
  try {
    read();
  } catch (const CaseError& error) {
    return error.what();
  }
  return "was not refused";
}

std::string refusal_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return refusal([&] { read_case_text(text, "case.toml", overrides); });
}

std::string repeated(const std::string& text, int times) {
  std::string all;
  for (int k = 0; k < times; ++k) all += text;
  return all;
}

void expect_part(const std::string& message, const std::string& part) {
  EXPECT_NE(message.find(part), std::string::npos) << message.substr(0, 300);
}

TEST(Limits, nesting) {
  expect_part(refusal_of("a = " + repeated("[", 100000)), "case.toml:1:");
  expect_part(refusal_of("a = " + repeated("{a=", 100000)), "case.toml:1:");
  expect_part(refusal_of(repeated("a.", 100000) + "a = 1"), "case.toml:1:102: more than 50 dots");
  expect_part(refusal_of(repeated("\"\".", 100000) + "a = 1"), "more than 50 dots");
  expect_part(refusal_of("a = " + repeated("{" + repeated("a.", 40) + "a = ", 100)), "case.toml:1:");
  expect_part(refusal_of(testing::kGoodCase, {repeated("a.", 100000) + "a=1"}), "dots");
  expect_part(refusal_of(testing::kGoodCase, {"seed=" + repeated("[", 100000)}), "--set");
}

TEST(Limits, dots_in_comments_are_only_dots) {
  EXPECT_NO_THROW(read_case_text("# " + repeated(".", 200) + "\n" + testing::kGoodCase, "case.toml"));
}

TEST(Limits, tables_of_a_kind) {
  expect_part(refusal_of(testing::kGoodCase + repeated("[[meter]]\n", 20000)), "tables, must be at most 10000");
  std::string kinds = testing::kGoodCase;
  for (int k = 0; k < 300; ++k)
    kinds += "[[particles]]\nname = \"k" + std::to_string(k) + "\"\nmaterial = \"bead\"\ndiameter = 1e-3\n";
  expect_part(refusal_of(kinds), "key 'particles': 301 kinds of particles, must be at most 255");
}

TEST(Limits, a_key_of_a_million_letters_is_just_unknown) {
  expect_part(refusal_of(std::string(1'000'000, 'a') + " = 1\n" + testing::kGoodCase), "unknown key");
}

TEST(Limits, bytes_of_a_case_file) {
  const Folder folder;
  const std::string path = folder.write("case.toml", testing::kGoodCase + std::string(17'000'000, '\n'));
  expect_part(refusal([&] { read_case(path); }), "must be at most 16000000");
}

TEST(Limits, a_csv_that_memory_does_not_hold) {
  const Folder folder;
  const std::string path = folder.write("fibres.csv", "x0,y0,z0,x1,y1,z1\n");
  std::filesystem::resize_file(path, 1'000'000'000'000);  // a hole: nothing on the disk
  const std::string text = testing::kGoodCase + std::string(R"(
[[fibres]]
name = "f"
material = "steel"
diameter = 1e-3
file = ")") + path + "\"\n";
  expect_part(refusal_of(text), "reading 1000 GB of CSV needs about 6000 GB of memory, there are ");
}

TEST(Limits, narrow_distributions_still_have_a_mean) {
  SizeDistribution size;
  size.kind = SizeDistribution::Kind::normal;
  size.mean = 1e-3, size.deviation = 1e-9, size.min = 1e-4, size.max = 2e-3;
  EXPECT_NEAR(mean_particle_volume(size) / (std::numbers::pi / 6 * 1e-9), 1, 1e-6);
  size.kind = SizeDistribution::Kind::lognormal, size.deviation = 1e-6;
  EXPECT_NEAR(mean_particle_volume(size) / (std::numbers::pi / 6 * 1e-9), 1, 1e-6);
  EXPECT_NEAR(share_between_limits(size), 1, 1e-9);
}

// ---- memory

TEST(Memory, the_least_of_machine_and_control_groups) {
  const Folder folder;
  folder.write("proc/meminfo", "MemTotal: 32000000 kB\nMemAvailable: 16000000 kB\n");
  EXPECT_EQ(available_memory(folder.path("")).bytes, 16000000.0 * 1024);
  folder.write("proc/self/cgroup", "0::/job/step\n");
  folder.write("sys/fs/cgroup/job/step/memory.max", "max\n");
  folder.write("sys/fs/cgroup/job/step/memory.current", "1000\n");
  EXPECT_EQ(available_memory(folder.path("")).bytes, 16000000.0 * 1024);
  folder.write("sys/fs/cgroup/job/memory.max", "5000000\n");
  folder.write("sys/fs/cgroup/job/memory.current", "3000000\n");
  folder.write("sys/fs/cgroup/job/memory.stat", "anon 2000000\ninactive_file 500000\n");
  EXPECT_EQ(available_memory(folder.path("")).bytes, 2500000);
  expect_part(available_memory(folder.path("")).limited_by, "control group");
}

TEST(Memory, the_older_control_groups_too) {
  const Folder folder;
  folder.write("proc/meminfo", "MemAvailable: 16000000 kB\n");
  folder.write("proc/self/cgroup", "5:cpu,cpuacct:/\n4:memory:/inside/a/container\n");
  folder.write("sys/fs/cgroup/memory/memory.limit_in_bytes", "7000000\n");
  folder.write("sys/fs/cgroup/memory/memory.usage_in_bytes", "3000000\n");
  EXPECT_EQ(available_memory(folder.path("")).bytes, 4000000);
}

TEST(Memory, a_run_that_cannot_fit_is_refused_with_both_figures) {
  const Case c = read_case_text(testing::kGoodCase, "case.toml",
                                {"stage.fill.mass=400", "region.inside.max=[100, 100, 100]", "domain.min=[-1, -1, -1]",
                                 "domain.max=[101, 101, 101]"});
  EXPECT_GT(memory_needed(c), 1e12);
  const Folder folder;
  RunOptions options;
  options.out = folder.path("run");
  const std::string message = refusal([&] { run_case(c, options); });
  expect_part(message, "case.toml: a run of ");
  expect_part(message, " GB of memory, there are ");
  EXPECT_FALSE(std::filesystem::exists(options.out));
}

TEST(Memory, the_limit_of_the_address_space_counts) {
  rlimit before{};
  getrlimit(RLIMIT_AS, &before);
  if (before.rlim_max != RLIM_INFINITY) GTEST_SKIP() << "the address space is limited from outside";
  rlimit limit = before;
  limit.rlim_cur = rlim_t{1} << 62;
  const Folder folder;
  ASSERT_EQ(setrlimit(RLIMIT_AS, &limit), 0);
  const AvailableMemory available = available_memory(folder.path(""));
  setrlimit(RLIMIT_AS, &before);
  expect_part(available.limited_by, "ulimit");
  EXPECT_LE(available.bytes, std::ldexp(1.0, 62));
}

[[gnu::noinline]] void use_stack() {
  [[maybe_unused]] volatile char stack[300'000];  // bytes; more than a process begins with
  for (size_t k = 0; k < sizeof stack; k += 4096) stack[sizeof stack - 1 - k] = 0;
}

// The kernel's own answer to a stack that cannot grow is a signal.
TEST(Memory, a_stack_that_cannot_grow_is_memory_that_ran_out) {
#ifdef SCREE_SHADOW_MEMORY
  GTEST_SKIP() << "a sanitizer's own memory has no such limit";
#endif
  rlimit before{};
  getrlimit(RLIMIT_AS, &before);
  if (before.rlim_max != RLIM_INFINITY) GTEST_SKIP() << "the address space is limited from outside";
  const auto leave = [](rlim_t bytes) {
    rlim_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    const rlimit limit{pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE)) + bytes, RLIM_INFINITY};
    if (setrlimit(RLIMIT_AS, &limit) != 0) _exit(1);
  };
  const auto with_room_for = [&](rlim_t bytes) {
    leave(bytes);
    try {
      take_stack();
    } catch (const std::bad_alloc&) {
      _exit(2);
    }
    leave(0);
    use_stack();
    _exit(0);
  };
  EXPECT_EXIT(with_room_for(256 << 10), ::testing::ExitedWithCode(2), "");
  EXPECT_EXIT(with_room_for(16 << 20), ::testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace scree
