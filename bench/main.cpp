// The benchmark program. Beside Google Benchmark's options it takes
//     --states=DIR    keep prepared states there as CSV files (bench/scenes.h)
//     --isa=NAME      the kernels' instruction set, as of `scree run`: avx512, avx2, neon, scalar
//     --prepare=NAME  with --states: only make that state: settled_tile, polydisperse_tile, drain_in_flow
#include <benchmark/benchmark.h>

#include <cstdio>
#include <exception>
#include <map>
#include <optional>
#include <string_view>
#include <vector>

#include "bench/scenes.h"
#include "bench/table.h"

namespace scree::bench {
namespace {

// Takes `option`=VALUE out of the arguments.
std::optional<std::string> taken_option(std::vector<char*>& arguments, std::string_view option) {
  for (size_t k = 1; k < arguments.size(); ++k) {
    const std::string_view argument = arguments[k];
    if (!argument.starts_with(option) || !argument.substr(option.size()).starts_with('=')) continue;
    const std::string value(argument.substr(option.size() + 1));
    arguments.erase(arguments.begin() + static_cast<std::ptrdiff_t>(k));
    return value;
  }
  return std::nullopt;
}

bool has_option(const std::vector<char*>& arguments, std::string_view option) {
  for (const std::string_view argument : arguments)
    if (argument.starts_with(option)) return true;
  return false;
}

int prepare(const std::string& name) {
  const std::map<std::string, State (*)()> states{
      {"settled_tile", [] { return settled_bed(monodisperse(), 1); }},
      {"polydisperse_tile", [] { return settled_bed(polydisperse(), 1); }},
      {"drain_in_flow", drain_in_flow},
  };
  const auto known = states.find(name);
  if (known == states.end()) {
    std::fprintf(stderr, "no state is named '%s'; there are settled_tile, polydisperse_tile, drain_in_flow\n",
                 name.c_str());
    return 2;
  }
  std::printf("%s: %zu grains\n", name.c_str(), known->second().size());
  return 0;
}

int run(std::vector<char*> arguments) {
  if (const auto folder = taken_option(arguments, "--states")) keep_states_in(*folder);
  if (const auto isa = taken_option(arguments, "--isa")) use_isa(*isa);
  if (const auto name = taken_option(arguments, "--prepare")) return prepare(*name);
  const bool own_table = !has_option(arguments, "--benchmark_format") && !has_option(arguments, "--benchmark_list");
  int count = static_cast<int>(arguments.size());
  benchmark::Initialize(&count, arguments.data());
  if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) return 2;
  TableReporter table;
  benchmark::RunSpecifiedBenchmarks(own_table ? &table : nullptr);
  return 0;
}

}  // namespace
}  // namespace scree::bench

int main(int argc, char** argv) {
  try {
    return scree::bench::run({argv, argv + argc});
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 3;
  }
}
