#include "runtime/memory.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <new>
#include <optional>
#include <sstream>

#include "runtime/average_grid.h"
#include "runtime/case_size.h"
#include "runtime/field_files.h"
#include "runtime/render/run_pictures.h"
#include "runtime/residence.h"
#include "runtime/touch_surface.h"

namespace scree {

namespace {

namespace fs = std::filesystem;

// Bytes a particle of the settled 400 um bed, lists and sort buffers included, at the peak of a rebuild: 356 were
// measured (bench/README.md, "Memory"), and a fifth for flows with longer lists. The reference precision keeps
// everything in double.
constexpr double kBytesPerParticle = 420, kBytesPerReferenceParticle = 700;
// The case's list, the engine's and its prepared tables, the search trees of the engine and of a fill: measured on
// lattices of 10^4 to 10^5 cells.
constexpr double kBytesPerPrimitive = 1300;
constexpr double kFixedBytes = 40e6;
constexpr double kAlwaysThere = 64e6;  // less than this is not worth looking

std::optional<double> number_in(const fs::path& file) {
  std::ifstream stream(file);
  double value = 0;
  if (!(stream >> value)) return std::nullopt;  // absent, or "max"
  return value;
}

// The number behind `key` in a file of lines "key number" or "key: number".
std::optional<double> number_behind(const fs::path& file, const std::string& key) {
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    std::istringstream words(line);
    std::string word;
    double value = 0;
    if (words >> word >> value && (word == key || word == key + ":")) return value;
  }
  return std::nullopt;
}

// One control group's limit less what it holds and cannot give back. No value: no limit.
std::optional<double> left_in_group(const fs::path& group, const char* limit, const char* usage, const char* cache) {
  const auto most = number_in(group / limit), used = number_in(group / usage);
  if (!most || !used) return std::nullopt;
  return std::max(0.0, *most - *used + number_behind(group / "memory.stat", cache).value_or(0));
}

// The process's group and every one above it: each may have a limit. Inside a container the path may not exist, the
// top then is the container's own group.
std::optional<double> left_in_groups(const fs::path& top, fs::path path, const char* limit, const char* usage,
                                     const char* cache) {
  std::optional<double> least;
  for (;; path = path.parent_path()) {
    if (const auto left = left_in_group(top / path.relative_path(), limit, usage, cache))
      least = std::min(*left, least.value_or(*left));
    if (path == path.parent_path()) return least;
  }
}

std::optional<double> left_in_control_groups(const fs::path& root) {
  std::ifstream stream(root / "proc/self/cgroup");
  std::optional<double> least;
  for (std::string line; std::getline(stream, line);) {  // number:controllers:path
    const size_t first = line.find(':'), second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = "," + line.substr(first + 1, second - first - 1) + ",";
    const fs::path path = line.substr(second + 1), groups = root / "sys/fs/cgroup";
    std::optional<double> left;
    if (controllers == ",,")
      left = left_in_groups(groups, path, "memory.max", "memory.current", "inactive_file");
    else if (controllers.find(",memory,") != std::string::npos)
      left = left_in_groups(groups / "memory", path, "memory.limit_in_bytes", "memory.usage_in_bytes",
                            "total_inactive_file");
    if (left) least = std::min(*left, least.value_or(*left));
  }
  return least;
}

std::optional<double> left_of_address_space(const fs::path& root) {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return std::nullopt;
  const double used = number_in(root / "proc/self/statm").value_or(0) * static_cast<double>(sysconf(_SC_PAGESIZE));
  return std::max(0.0, static_cast<double>(limit.rlim_cur) - used);
}

}  // namespace

AvailableMemory available_memory(const fs::path& root) {
  AvailableMemory least{std::numeric_limits<double>::infinity(), "nothing"};
  const auto limit = [&](std::optional<double> bytes, const char* by) {
    if (bytes && *bytes < least.bytes) least = {*bytes, by};
  };
  const auto free_kilobytes = number_behind(root / "proc/meminfo", "MemAvailable");
  if (free_kilobytes) limit(*free_kilobytes * 1024, "the free memory of this machine");
  limit(left_in_control_groups(root), "the limit of the control group");
  limit(left_of_address_space(root), "the limit of `ulimit -v`");
  return least;
}

double memory_of_particles(const Case& c, double count) {
  return count * (c.contact.precision == Precision::reference ? kBytesPerReferenceParticle : kBytesPerParticle);
}

double memory_of_primitives(double count) { return count * kBytesPerPrimitive; }

double memory_needed(const Case& c) {
  const double count = expected_particles(c);
  const double frame = writes_fields(c.output.fields) ? kFieldBytesPerParticle : 0;
  const double picture = c.output.pictures.empty() ? 0 : kPictureBytesPerParticle;
  // A frame that is not written yet. Of few particles two may wait while a third is made of all its columns: at most
  // some 65 MB.
  const double waiting = frame > 0 && picture > 0 ? kPackedBytesPerParticle : 0;
  double bytes = kFixedBytes + memory_of_particles(c, count) + std::max(frame, picture + waiting) * count +
                 memory_of_primitives(static_cast<double>(c.solid.primitives.size()));
  if (c.output.residence.enabled) bytes += kResidenceBytesPerParticle * count;
  if (!c.output.averages.empty()) bytes += kAverageBytesPerParticle * std::min(count, kAverageParticlesAtOnce);
  for (const AverageSettings& average : c.output.averages) bytes += memory_of_average(average);
  if (c.output.touch.enabled) bytes += kBytesPerTouchCell * cells_of_touch(c);
  return bytes;
}

std::string bytes_text(double bytes) {
  return bytes < 1e9 ? fmt::format("{:.0f} MB", bytes / 1e6) : fmt::format("{:.4g} GB", bytes / 1e9);
}

void require_memory(const SourcePlace& place, const std::string& what, double bytes) {
  if (bytes <= kAlwaysThere) return;
  const AvailableMemory available = available_memory();
  if (bytes <= available.bytes) return;
  throw CaseError(place, fmt::format("{} about {} of memory, there are {} ({})", what, bytes_text(bytes),
                                     bytes_text(available.bytes), available.limited_by));
}

void require_memory(const Case& c) {
  require_memory({c.source, 0, 0},
                 fmt::format("a run of {:.4g} particles and {} fibres and walls needs", expected_particles(c),
                             c.solid.primitives.size()),
                 memory_needed(c));
}

namespace {

constexpr size_t kStack = 512 << 10;  // bytes: a step's kernel takes 170,000, all else less

[[gnu::noinline]] void touch_stack() {
  [[maybe_unused]] volatile char stack[kStack];
  for (size_t k = 0; k < kStack; k += 4096) stack[kStack - 1 - k] = 0;  // downwards, as it grows
}

}  // namespace

void take_stack() {
  rlimit limit{};
  if (getrlimit(RLIMIT_STACK, &limit) == 0 && limit.rlim_cur < 2 * kStack) return;  // `ulimit -s`: it has to do
  if (const auto left = left_of_address_space("/"); left && *left < 2 * kStack) throw std::bad_alloc();
  touch_stack();
}

}  // namespace scree
