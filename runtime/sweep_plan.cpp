#include "runtime/sweep_plan.h"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <filesystem>
#include <map>

#include "runtime/case_reader.h"
#include "runtime/case_table.h"

namespace scree {

namespace {

namespace fs = std::filesystem;

// Fit for a folder's name on any system and a shell without quotes.
std::string plain(const std::string& text) {
  std::string result = text;
  for (char& c : result)
    if (!std::isalnum(static_cast<unsigned char>(c)) && !strchr("._+-", c)) c = '_';
  return result;
}

// 0.75 for 0.75, epsd2 for "epsd2".
std::string value_text(const CaseNode& node) { return node.text() ? *node.text() : inline_toml(node); }

std::optional<double> value_number(const CaseNode& node) {
  if (const auto* number = std::get_if<double>(&node.value)) return *number;
  if (const auto* number = std::get_if<int64_t>(&node.value)) return static_cast<double>(*number);
  return std::nullopt;
}

std::string case_beside(TableReader& top) {
  const std::string file = top.text("case");
  const fs::path path = fs::absolute(fs::path(top.place("case").file).parent_path() / file).lexically_normal();
  if (!fs::is_regular_file(path)) top.fail("case", fmt::format("the file \"{}\" does not exist", path.string()));
  return path.string();
}

// Where each key of the case is set, so that none is set twice.
class KeysSet {
 public:
  void add(const std::string& key, const SourcePlace& place) {
    const auto [at, is_new] = places_.emplace(key, place);
    if (!is_new)
      throw CaseError(place, fmt::format("the case's key '{}' is set twice, the other time at {}: it must be in one "
                                         "place of a sweep only",
                                         key, to_string(at->second)));
  }

 private:
  std::map<std::string, SourcePlace> places_;
};

// The list under `key` with at least one element.
const CaseNode::Array& list_of(TableReader& t, const CaseNode& table, const std::string& key, const char* wanted) {
  t.one_of({key});
  const CaseNode& node = find_entry(table, key)->node;
  if (!node.array()) t.fail(key, fmt::format("{} is not a list, must be {}", t.shown(key), wanted));
  if (node.array()->empty()) t.fail(key, fmt::format("[] is empty, must be {}", wanted));
  return *node.array();
}

SweepValue one_value(const std::string& key, const CaseNode& node) {
  return {value_text(node), value_number(node), {fmt::format("{}={}", key, inline_toml(node))}, node.place};
}

SweepValue one_row(TableReader& t, const std::vector<std::string>& keys, const CaseNode& row) {
  if (!row.array() || row.array()->size() != keys.size())
    throw CaseError(row.place, fmt::format("key '{}': the row {} must be a list of {} values, one for each of: {}",
                                           t.full_key("rows"), inline_toml(row), keys.size(), fmt::join(keys, ", ")));
  SweepValue value{"", std::nullopt, {}, row.place};
  for (size_t k = 0; k < keys.size(); ++k) {
    const CaseNode& node = (*row.array())[k];
    value.text += (k ? "_" : "") + value_text(node);
    value.set.push_back(fmt::format("{}={}", keys[k], inline_toml(node)));
  }
  return value;
}

void name_values(TableReader& t, SweepParameter& p) {
  if (!t.has("names")) return;
  const std::vector<std::string> names = t.texts("names");
  if (names.size() != p.values.size())
    t.fail("names", fmt::format("{} has {} entries, must be {}: one for each value", t.shown("names"), names.size(),
                                p.values.size()));
  for (size_t k = 0; k < names.size(); ++k) p.values[k].text = names[k], p.values[k].number.reset();
}

SweepParameter read_parameter(TableReader& t, const CaseNode& table, KeysSet& set) {
  SweepParameter p;
  if (t.one_of({"key", "keys"}) == "key") {
    p.keys = {t.text("key")};
    for (const CaseNode& node : list_of(t, table, "values", "a list of values, e.g. [0.3, 0.5, 1.0]"))
      p.values.push_back(one_value(p.keys[0], node));
  } else {
    p.keys = t.texts("keys");
    for (const CaseNode& row : list_of(t, table, "rows", "a list of rows, e.g. [[1e-3, 10e-3], [2e-3, 20e-3]]"))
      p.values.push_back(one_row(t, p.keys, row));
  }
  for (const std::string& key : p.keys) set.add(key, t.place(p.keys.size() > 1 || !t.has("key") ? "keys" : "key"));
  name_values(t, p);
  p.label = t.has("label") ? t.text("label") : p.keys[0].substr(p.keys[0].rfind('.') + 1);
  t.finish();
  return p;
}

void read_parameters(TableReader& top, CaseNode& tree, SweepPlan& plan, KeysSet& set) {
  std::vector<TableReader> tables = top.tables("parameter");
  for (size_t k = 0; k < tables.size(); ++k) {
    const CaseNode& table = (*find_entry(tree, "parameter")->node.array())[k];
    SweepParameter p = read_parameter(tables[k], table, set);
    for (const SweepParameter& other : plan.parameters)
      if (plain(other.label) == plain(p.label))
        tables[k].fail("label", fmt::format("two parameters are called '{}': give this one another label", p.label));
    plan.parameters.push_back(std::move(p));
  }
}

void read_seeds(TableReader& top, CaseNode& tree, SweepPlan& plan, KeysSet& set) {
  if (!top.has("seeds")) return;
  set.add("seed", top.place("seeds"));
  for (const CaseNode& node : list_of(top, tree, "seeds", "a list of whole numbers, e.g. [1, 2, 3]")) {
    const auto* seed = std::get_if<int64_t>(&node.value);
    if (!seed || *seed < 0)
      throw CaseError(node.place, fmt::format("key 'seeds': {} must be a whole number, 0 or more", inline_toml(node)));
    plan.seeds.push_back(static_cast<uint64_t>(*seed));
  }
}

// [set] with dotted keys is a tree of tables: its leaves as "key=value".
void collect_set(const CaseNode& node, const std::string& path, std::vector<std::string>& out, KeysSet& set) {
  for (const CaseEntry& entry : *node.table()) {
    const std::string key = path.empty() ? entry.key : path + "." + entry.key;
    if (entry.node.table()) {
      collect_set(entry.node, key, out, set);
    } else {
      set.add(key, entry.place);
      out.push_back(fmt::format("{}={}", key, inline_toml(entry.node)));
    }
  }
}

std::vector<std::string> read_set(TableReader& top, CaseNode& tree, KeysSet& set) {
  std::vector<std::string> result;
  if (!top.has("set")) return result;
  top.table("set");
  collect_set(find_entry(tree, "set")->node, "", result, set);
  return result;
}

constexpr double kMostReference = 1e9;  // in any of the units: more than a slip of the pen leaves room for

std::optional<SweepReference> read_reference(TableReader& top) {
  if (!top.has("reference")) return std::nullopt;
  TableReader t = top.table("reference");
  SweepReference reference;
  reference.label = t.text("label");
  reference.value = t.number("value", positive(kMostReference, ""));
  reference.unit = t.choice("unit", Choices<const char*>{{"kg/s", "kg/s"}, {"s", "s"}, {"kg", "kg"}});
  t.finish();
  return reference;
}

std::vector<SweepCaption> read_captions(TableReader& top) {
  std::vector<SweepCaption> captions;
  if (!top.has("captions")) return captions;
  TableReader t = top.table("captions");
  for (const char* chart : kSweepCharts)
    if (t.has(chart)) captions.push_back({chart, t.text(chart)});
  t.finish();
  return captions;
}

std::string name_of(const SweepPlan& plan, const SweepRun& run) {
  std::string name;
  for (size_t p = 0; p < run.values.size(); ++p)
    name += fmt::format("{}{}_{}", name.empty() ? "" : "__", plain(plan.parameters[p].label),
                        plain(plan.parameters[p].values[run.values[p]].text));
  if (run.seed) name += fmt::format("{}seed_{}", name.empty() ? "" : "__", *run.seed);
  return name.empty() ? "run" : name;
}

void add_run(SweepPlan& plan, const std::vector<std::string>& common, const std::vector<size_t>& values,
             std::optional<uint64_t> seed) {
  SweepRun run{"", values, seed, common, ""};
  for (size_t p = 0; p < values.size(); ++p) {
    const std::vector<std::string>& set = plan.parameters[p].values[values[p]].set;
    run.set.insert(run.set.end(), set.begin(), set.end());
  }
  if (seed) run.set.push_back(fmt::format("seed={}", *seed));
  run.name = name_of(plan, run);
  plan.runs.push_back(std::move(run));
}

// Counts through the product as an odometer does.
void expand(SweepPlan& plan, const std::vector<std::string>& common) {
  std::vector<size_t> values(plan.parameters.size(), 0);
  for (;;) {
    if (plan.seeds.empty()) add_run(plan, common, values, std::nullopt);
    for (const uint64_t seed : plan.seeds) add_run(plan, common, values, seed);
    size_t p = values.size();
    while (p > 0 && ++values[p - 1] == plan.parameters[p - 1].values.size()) values[--p] = 0;
    if (p == 0) return;
  }
}

void check_size(const SweepPlan& plan, const SourcePlace& place) {
  double runs = static_cast<double>(std::max<size_t>(1, plan.seeds.size()));
  for (const SweepParameter& p : plan.parameters) runs *= static_cast<double>(p.values.size());
  if (runs > kMostSweepRuns)
    throw CaseError(place, fmt::format("the sweep has {:.0f} runs, must be at most {}", runs, kMostSweepRuns));
}

void check_names(const SweepPlan& plan, const SourcePlace& place) {
  std::map<std::string, const SweepRun*> seen;
  for (const SweepRun& run : plan.runs) {
    const auto [at, is_new] = seen.emplace(run.name, &run);
    if (is_new) continue;
    SourcePlace where = place;  // of the value that is there twice
    for (size_t p = 0; p < run.values.size(); ++p)
      if (run.values[p] != at->second->values[p]) where = plan.parameters[p].values[run.values[p]].place;
    throw CaseError(where, fmt::format("two runs have the name '{}': values, names and seeds must differ from one "
                                       "another, also when only letters, digits and ._+- count",
                                       run.name));
  }
}

// An override that the case refuses is an error of the value in the sweep file.
SourcePlace place_of(const SweepPlan& plan, const SweepRun& run, const std::string& error, const SourcePlace& other) {
  for (size_t p = 0; p < run.values.size(); ++p) {
    const SweepValue& value = plan.parameters[p].values[run.values[p]];
    for (const std::string& set : value.set)
      if (error.starts_with("--set " + set + ":")) return value.place;
  }
  return other;
}

void check_cases(SweepPlan& plan, const SourcePlace& place) {
  for (SweepRun& run : plan.runs) {
    try {
      run.understood = read_case(plan.case_file, run.set).understood;
    } catch (const CaseError& e) {
      throw CaseError(place_of(plan, run, e.what(), place), fmt::format("run '{}': {}", run.name, e.what()));
    }
  }
}

}  // namespace

SweepPlan read_sweep(const std::string& path) {
  CaseNode tree = load_case_tree(path, {});
  TableReader top(tree, "");
  SweepPlan plan;
  KeysSet set;
  const std::string stem = fs::path(path).stem().string();
  plan.title = top.has("title") ? top.text("title") : stem;
  plan.case_file = case_beside(top);
  read_seeds(top, tree, plan, set);
  const std::vector<std::string> common = read_set(top, tree, set);
  plan.reference = read_reference(top), plan.captions = read_captions(top);
  read_parameters(top, tree, plan, set);
  top.finish();
  const SourcePlace place = top.place("case");
  check_size(plan, place);
  expand(plan, common);
  check_names(plan, place);
  check_cases(plan, place);
  return plan;
}

}  // namespace scree
