// The table of runs that a sweep file describes. Keys of the file:
//     title                      of the report, optional
//     case                       the case file, relative to the sweep file
//     seeds = [1, 2, 3]          every combination once for each seed; optional
//     [set]                      keys of the case that are the same in all runs; optional
//     [reference]                a line to draw in the charts of that quantity, e.g. a measurement; optional
//       label, value, unit       unit: "kg/s" (mass flow), "s" (drain time) or "kg" (mass left)
//     [captions]                 what a chart may be held against, in words; optional. Keys: kSweepCharts
//     [[parameter]]              one or more (none: seeds only); the sweep is the product of all
//       key, values              a key of the case as in --set, and what it takes
//       keys, rows               or several keys that change together: one row of values for each step
//       names                    optional: what the steps are called
//       label                    optional: the parameter's name in folders, tables and charts (default: the key's end)
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "runtime/case_error.h"

namespace scree {

// One step of a parameter.
struct SweepValue {
  std::string text;              // its name
  std::optional<double> number;  // if it is one
  std::vector<std::string> set;  // "key=value" for each key
  SourcePlace place;
};

struct SweepParameter {
  std::string label;
  std::vector<std::string> keys;
  std::vector<SweepValue> values;
};

// The charts of a sweep's report that may have a caption.
inline constexpr const char* kSweepCharts[] = {"flow_curves", "discharged_curves", "steady_flow", "drain_time",
                                               "retained"};

struct SweepCaption {
  std::string chart, text;
};

// A level that the runs are held against. `value` in `unit`, one of kg/s, s, kg.
struct SweepReference {
  std::string label;
  double value;
  std::string unit;
};

struct SweepRun {
  std::string name;            // of its folder: letters, digits, and . _ + -
  std::vector<size_t> values;  // index of the step of each parameter
  std::optional<uint64_t> seed;
  std::vector<std::string> set;  // all overrides, as for read_case() and --set
  std::string understood;        // the run's case in full, see Case::understood
};

struct SweepPlan {
  std::string title, case_file;
  std::vector<SweepParameter> parameters;
  std::vector<uint64_t> seeds;
  std::optional<SweepReference> reference;
  std::vector<SweepCaption> captions;
  std::vector<SweepRun> runs;  // the last parameter changes fastest, seeds faster still
};

inline constexpr size_t kMostSweepRuns = 10000;

// Reads and checks a sweep file and the case of every run. Throws CaseError with file, line and what is allowed: for an
// unknown key of the sweep file or the case, an empty list, a key that is set twice, two runs with one name.
SweepPlan read_sweep(const std::string& path);

}  // namespace scree
