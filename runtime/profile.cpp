#include "runtime/profile.h"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

namespace scree {

std::vector<ProfileLine> profile_of(const EngineCounters& k, int threads, double wall_seconds) {
  const auto each = [threads](double seconds) { return seconds / std::max(1, threads); };
  std::vector<ProfileLine> lines{{"near checks", each(k.near_check_seconds)},
                                 {"particle-particle contacts", each(k.pair_seconds)},
                                 {"fibre and wall contacts", each(k.solid_seconds)},
                                 {"integration", each(k.integration_seconds)}};
  const double busy = std::accumulate(lines.begin(), lines.end(), 0.0,
                                      [](double sum, const ProfileLine& line) { return sum + line.seconds; });
  lines.push_back({"threads waiting for each other", std::max(0.0, k.step_seconds - busy)});
  lines.push_back({"rebuild: histories", k.history_seconds});
  lines.push_back({"rebuild: sort", k.sort_seconds});
  lines.push_back({"rebuild: pair search", k.pair_search_seconds});
  lines.push_back({"rebuild: fibre and wall search", k.solid_search_seconds});
  double known = 0;
  for (const ProfileLine& line : lines) known += line.seconds;
  lines.push_back({"the rest: insertion, meters, output", std::max(0.0, wall_seconds - known)});
  return lines;
}

std::string profile_table(const std::vector<ProfileLine>& lines, uint64_t particle_steps) {
  double total = 0;
  for (const ProfileLine& line : lines) total += line.seconds;
  std::string table =
      fmt::format("{:<36} {:>9} {:>7} {:>16}\n", "part of the run", "seconds", "share", "ns/particle-step");
  const auto row = [&](const std::string& part, double seconds) {
    table += fmt::format("{:<36} {:>9.3f} {:>6.1f}% {:>16.3f}\n", part, seconds, total > 0 ? 100 * seconds / total : 0,
                         particle_steps > 0 ? 1e9 * seconds / static_cast<double>(particle_steps) : 0);
  };
  for (const ProfileLine& line : lines) row(line.part, line.seconds);
  row("all", total);
  return table;
}

}  // namespace scree
