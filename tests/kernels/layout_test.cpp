// Imports run one way: geometry <- kernels <- runtime; a foreign library lives behind one file.
#include <gtest/gtest.h>

#include <cctype>
#include <filesystem>
#include <fstream>
#include <functional>
#include <set>
#include <sstream>
#include <string>

namespace scree {
namespace {

namespace fs = std::filesystem;
const fs::path kRoot = SCREE_SOURCE_DIR;

std::string text_of(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

// The sources of these rooms for which `wanted` holds, as paths from the root.
std::set<std::string> sources_where(const std::set<std::string>& rooms,
                                    const std::function<bool(const std::string& text)>& wanted) {
  std::set<std::string> result;
  for (const std::string& room : rooms)
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / room))
      if (const auto suffix = entry.path().extension(); suffix == ".h" || suffix == ".cpp")
        if (wanted(text_of(entry.path()))) result.insert(fs::relative(entry.path(), kRoot).string());
  return result;
}

// Whether some line is an #include of a path that begins with `prefix`.
auto includes(const std::string& prefix) {
  return [prefix](const std::string& text) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
      const size_t hash = line.find_first_not_of(" \t");
      if (hash == std::string::npos || line[hash] != '#' || line.find("include") == std::string::npos) continue;
      const size_t open = line.find_first_of("\"<");
      if (open != std::string::npos && line.compare(open + 1, prefix.size(), prefix) == 0) return true;
    }
    return false;
  };
}

auto names(const std::string& word) {
  return [word](const std::string& text) { return text.find(word) != std::string::npos; };
}

using Files = std::set<std::string>;
const Files kRooms{"geometry", "kernels", "runtime"};

TEST(Layout, GeometryIncludesNothingOfKernelsOrRuntime) {
  EXPECT_EQ(sources_where({"geometry"}, includes("kernels/")), Files{});
  EXPECT_EQ(sources_where({"geometry"}, includes("runtime/")), Files{});
}

TEST(Layout, KernelsIncludeNothingOfRuntime) {
  EXPECT_EQ(sources_where({"kernels"}, includes("runtime/")), Files{});
  EXPECT_FALSE(sources_where({"kernels"}, includes("geometry/")).empty());  // the walk sees includes
}

TEST(Layout, NothingIncludesTestsOrBenchmarks) {
  for (const char* room : {"tests/", "bench/"}) EXPECT_EQ(sources_where(kRooms, includes(room)), Files{});
}

TEST(Layout, OneFileNamesTheSimdLibrary) {
  EXPECT_EQ(sources_where(kRooms, includes("hwy/")), Files{"kernels/simd.h"});
  EXPECT_EQ(sources_where(kRooms, includes("immintrin")), Files{});
}

// No names of sets elsewhere, no intrinsics, no builtins of one, no macros that ask. Comments may speak of them.
TEST(Layout, OneFileNamesInstructionSets) {
  const auto names_a_set = [](const std::string& text) {
    static const char* const sets[] = {
        "avx",        "sse2",   "sse3",        "sse4",          "neon",           "altivec",
        "__x86_64__", "_m_x64", "__aarch64__", "__arm",         "_mm_",           "_mm256_",
        "_mm512_",    "vld1q_", "vst1q_",      "__builtin_cpu", "__builtin_ia32", "__builtin_aarch64"};
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
      std::string code = line.substr(0, line.find("//"));
      for (char& c : code) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      for (const char* set : sets)
        if (code.find(set) != std::string::npos) return true;
    }
    return false;
  };
  EXPECT_EQ(sources_where(kRooms, names_a_set), Files{"kernels/simd.h"});
  for (const char* known : {"if (isa == \"avx2\")", "#if defined(__aarch64__)", "__builtin_cpu_init();",
                            "x = _mm256_add_ps(a, b);", "y = vld1q_f32(p);"})
    EXPECT_TRUE(names_a_set(known)) << known;
  EXPECT_FALSE(names_a_set("const int savings = pressed + message;  // AVX-512"));
}

TEST(Layout, OneFileNamesTheThreadingRuntime) {
  EXPECT_EQ(sources_where(kRooms, includes("omp.h")), Files{"kernels/parallel.h"});
  EXPECT_EQ(sources_where(kRooms, names("#pragma omp")), Files{"kernels/parallel.h"});
  EXPECT_EQ(sources_where(kRooms, includes("tbb/")), Files{});
}

TEST(Layout, OneFileIncludesEmbree) {
  EXPECT_EQ(sources_where(kRooms, includes("embree")), Files{"geometry/embree.h"});
}

// Files, logging and case files stay out of the data-parallel core.
TEST(Layout, KernelsKnowNoFilesAndNoFormats) {
  for (const char* foreign : {"toml", "hdf5", "spdlog", "fstream", "iostream", "filesystem"})
    EXPECT_EQ(sources_where({"kernels"}, includes(foreign)), Files{}) << foreign;
}

TEST(Layout, EveryHeaderIsIncludedOnce) {
  const auto unguarded = [](const std::string& text) { return text.find("#pragma once") == std::string::npos; };
  for (const std::string& file : sources_where(kRooms, unguarded))
    EXPECT_TRUE(file.ends_with(".cpp")) << file << " has no #pragma once";
}

}  // namespace
}  // namespace scree
