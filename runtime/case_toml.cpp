#include "runtime/case_toml.h"

#include <toml++/toml.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "runtime/case_merge.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

constexpr double kMostBytes = 16e6;  // of a case file: more than a person writes; long lists go into CSV files
constexpr int kMostDots = 50;        // in a key: each is a level of nesting, and levels take stack
constexpr int kMostLevels = 300;
constexpr size_t kMostTables = 1e4;  // under one [[name]]
constexpr size_t kMostBases = 100;   // one based on the other

SourcePlace place_of(const toml::source_region& source, const std::string& file) {
  return {file, static_cast<int>(source.begin.line), static_cast<int>(source.begin.column)};
}

CaseNode convert(const toml::node& node, const std::string& file, int level);

CaseNode::Table convert_table(const toml::table& table, const std::string& file, int level) {
  CaseNode::Table result;
  for (const auto& [key, node] : table) {
    result.push_back({std::string(key.str()), place_of(key.source(), file), convert(node, file, level), false});
  }
  result.sort([](const CaseEntry& a, const CaseEntry& b) {  // toml++ sorts by name
    return std::pair(a.place.line, a.place.column) < std::pair(b.place.line, b.place.column);
  });
  return result;
}

CaseNode convert(const toml::node& node, const std::string& file, int level) {
  CaseNode result;
  result.place = place_of(node.source(), file);
  if (level > kMostLevels) throw CaseError(result.place, fmt::format("nested more than {} deep", kMostLevels));
  if (const auto* table = node.as_table()) {
    result.value = convert_table(*table, file, level + 1);
  } else if (const auto* array = node.as_array()) {
    CaseNode::Array elements;
    for (const toml::node& element : *array) elements.push_back(convert(element, file, level + 1));
    if (array->is_array_of_tables() && array->size() > kMostTables)
      throw CaseError(result.place, fmt::format("{} tables, must be at most {}; many fibres go into a CSV file: "
                                                "[[fibres]] file = \"...\"",
                                                array->size(), kMostTables));
    result.value = std::move(elements);
  } else if (const auto* text = node.as_string()) {
    result.value = text->get();
  } else if (const auto* number = node.as_floating_point()) {
    result.value = number->get();
  } else if (const auto* integer = node.as_integer()) {
    result.value = integer->get();
  } else if (const auto* flag = node.as_boolean()) {
    result.value = flag->get();
  } else {
    throw CaseError(result.place, "a date or time means nothing in a case file, write seconds as a number");
  }
  return result;
}

// toml++ limits the nesting of brackets, but a key a.b.c.... nests as deep as it is long. Lines of comment may hold
// dots.
void check_dots(const std::string& text, const std::string& file) {
  int dots = 0, line = 1, column = 0;
  bool blank = true, comment = false;  // so far in this line
  for (const char c : text) {
    ++column;
    if (c == '\n') {
      ++line, column = dots = 0;
      blank = true, comment = false;
      continue;
    }
    comment = comment || (blank && c == '#');
    blank = blank && (c == ' ' || c == '\t');
    if (strchr("=,[]{}", c)) dots = 0;
    if (c == '.' && ++dots > kMostDots && !comment)
      throw CaseError({file, line, column}, fmt::format("more than {} dots between two separators", kMostDots));
  }
}

CaseNode parse_text(const std::string& text, const std::string& file) {
  check_dots(text, file);
  try {
    CaseNode tree = convert(toml::parse(text), file, 0);
    tree.place = {file, 1, 1};
    return tree;
  } catch (const toml::parse_error& error) {
    throw CaseError(place_of(error.source(), file), fmt::format("not valid TOML: {}", error.description()));
  }
}

std::string read_text(const fs::path& path, const SourcePlace& place) {
  std::error_code error;
  std::ifstream stream(path, std::ios::binary);
  if (!stream || !fs::is_regular_file(path, error)) {
    throw CaseError(place, fmt::format("the file '{}' cannot be read", path.string()));
  }
  const double bytes = static_cast<double>(fs::file_size(path, error));
  if (bytes > kMostBytes)
    throw CaseError(place,
                    fmt::format("the file '{}' has {:.0f} bytes, must be at most {:.0f}: long lists of fibres and "
                                "particles go into CSV files",
                                path.string(), bytes, kMostBytes));
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

// The base files of `tree`, in order; takes the key out of the tree.
std::vector<CaseNode> take_bases(CaseNode& tree) {
  CaseEntry* base = find_entry(tree, "base");
  if (!base) return {};
  std::vector<CaseNode> bases = base->node.array() ? *base->node.array() : CaseNode::Array{base->node};
  for (const CaseNode& one : bases) {
    if (one.text()) continue;
    throw CaseError(one.place, fmt::format("key 'base': {} is not a file name, must be a string or a list of strings",
                                           inline_toml(one)));
  }
  tree.table()->remove_if([](const CaseEntry& entry) { return entry.key == "base"; });
  return bases;
}

fs::path canonical_form(const fs::path& path) {
  std::error_code error;
  const fs::path canonical = fs::weakly_canonical(path, error);
  return error ? path : canonical;
}

// Merges files into one tree, bases before the files that name them.
struct Loader {
  CaseNode tree;
  std::set<fs::path> merged;
  std::vector<fs::path> open;  // the chain of bases being read, to find loops

  void load(const fs::path& path, const SourcePlace& place) { load(read_text(path, place), path); }

  void load(const std::string& text, const fs::path& path) {
    CaseNode own = parse_text(text, path.string());
    const fs::path canonical = canonical_form(path);
    open.push_back(canonical);
    for (const CaseNode& base : take_bases(own)) {
      const fs::path base_path = (path.parent_path() / *base.text()).lexically_normal();
      const fs::path base_canonical = canonical_form(base_path);
      if (open.size() >= kMostBases)
        throw CaseError(base.place, fmt::format("key 'base': more than {} files based one on the other", kMostBases));
      if (std::find(open.begin(), open.end(), base_canonical) != open.end()) {
        throw CaseError(base.place, fmt::format("key 'base': '{}' leads back to itself", *base.text()));
      }
      if (!merged.contains(base_canonical)) load(base_path, base.place);
    }
    open.pop_back();
    merged.insert(canonical);
    merge_tables(tree, std::move(own));
  }
};

bool is_bare_word(const std::string& text) {
  return !text.empty() && std::isalpha(static_cast<unsigned char>(text[0])) &&
         std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isalnum(c) || strchr("_-./+", c); });
}

CaseNode parse_override_value(const std::string& text, const SourcePlace& place) {
  CaseNode value;
  try {
    check_dots(text, place.file);
    const toml::table table = toml::parse("value = " + text);
    if (table.size() != 1) throw CaseError(place, "one value is needed behind '='");
    value = convert(*table.get("value"), place.file, 0);
  } catch (const toml::parse_error& error) {
    if (!is_bare_word(text)) {
      throw CaseError(place, fmt::format("'{}' is not a TOML value: {}", text, error.description()));
    }
    value.value = text;
  }
  return value;
}

void apply_override(CaseNode& tree, const std::string& text) {
  const SourcePlace place{"--set " + text, 0, 0};
  const size_t equals = text.find('=');
  if (equals == 0 || equals == std::string::npos) throw CaseError(place, "an override is written key.path=value");
  CaseNode value = parse_override_value(text.substr(equals + 1), place);
  set_places(value, place);
  if (std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(equals), '.') > kMostDots)
    throw CaseError(place, fmt::format("more than {} dots in the key", kMostDots));
  set_at_path(tree, text.substr(0, equals), std::move(value), place);
}

}  // namespace

CaseNode parse_case_text(const std::string& text, const std::string& file) { return parse_text(text, file); }

CaseNode load_case_tree(const std::string& path, const std::vector<std::string>& overrides) {
  return load_case_tree(read_text(path, {path, 0, 0}), path, overrides);
}

CaseNode load_case_tree(const std::string& text, const std::string& path, const std::vector<std::string>& overrides) {
  Loader loader;
  loader.tree.value = CaseNode::Table{};
  loader.tree.place = {path, 1, 1};
  loader.load(text, path);
  for (const std::string& override_text : overrides) apply_override(loader.tree, override_text);
  return std::move(loader.tree);
}

}  // namespace scree
