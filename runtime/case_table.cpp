#include "runtime/case_table.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace scree {
namespace {

constexpr size_t kMostTables = 10000;  // of one kind: each is compared with all before it, and a person wrote them

std::string shortened(const std::string& text) { return text.size() <= 80 ? text : text.substr(0, 77) + "..."; }

CaseNode node_of(double value) { return {value, {}, {}}; }
CaseNode node_of(const std::string& value) { return {value, {}, {}}; }
CaseNode node_of(const Vec3& v) { return {CaseNode::Array{node_of(v.x), node_of(v.y), node_of(v.z)}, {}, {}}; }

std::string did_you_mean(const std::string& word, const std::vector<std::string>& known) {
  const auto near = nearest_word(word, known);
  return near ? fmt::format("; did you mean '{}'?", *near) : "";
}

}  // namespace

bool holds(const Range& range, double value) {
  return std::isfinite(value) && value <= range.max && (range.above_min ? value > range.min : value >= range.min);
}

std::string to_string(const Range& range) {
  const std::string unit = *range.unit ? fmt::format(" {}", range.unit) : "";
  if (range.max > 1e100) {
    return range.min < -1e100
               ? fmt::format("any number{}", unit)
               : fmt::format("{} {:g}{}", range.above_min ? "greater than" : "at least", range.min, unit);
  }
  if (range.above_min) return fmt::format("greater than {:g} and at most {:g}{}", range.min, range.max, unit);
  return fmt::format("between {:g} and {:g}{}", range.min, range.max, unit);
}

SourcePlace TableReader::place(const std::string& key) const {
  const CaseEntry* entry = find_entry(*node_, key);
  if (!entry || entry->node.place.file.empty()) return node_->place;  // absent, or a default
  return entry->node.place;
}

std::string TableReader::shown(const std::string& key) const {
  const CaseEntry* entry = find_entry(*node_, key);
  return entry ? shortened(inline_toml(entry->node)) : "not given";
}

void TableReader::fail(const std::string& key, const std::string& problem) const {
  throw CaseError(place(key), fmt::format("key '{}': {}", full_key(key), problem));
}

void TableReader::fail_type(const std::string& key, const CaseNode& node, const std::string& wanted) const {
  throw CaseError(node.place, fmt::format("key '{}': {} is of the wrong type, must be {}", full_key(key),
                                          shortened(inline_toml(node)), wanted));
}

void TableReader::fail_unknown(const std::string& key, const std::string& word, const std::string& what,
                               const std::vector<std::string>& known) const {
  const std::string allowed = known.empty() ? "there is none" : fmt::format("known: {}", fmt::join(known, ", "));
  fail(key, fmt::format("unknown {} '{}', {}{}", what, word, allowed, did_you_mean(word, known)));
}

void TableReader::fail_unknown_key(const CaseEntry& entry) const {
  const std::string value = shortened(inline_toml(entry.node));
  throw CaseError(entry.place, fmt::format("key '{}': unknown key (value {}), known here: {}{}", full_key(entry.key),
                                           value, fmt::join(known_, ", "), did_you_mean(entry.key, known_)));
}

CaseNode* TableReader::find(const std::string& key) {
  if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.push_back(key);
  CaseEntry* entry = find_entry(*node_, key);
  if (!entry) return nullptr;
  entry->used = true;
  return &entry->node;
}

CaseNode& TableReader::require(const std::string& key) {
  if (CaseNode* node = find(key)) return *node;
  for (const CaseEntry& entry : *node_->table()) {  // perhaps it is there, but misspelt
    if (!entry.used && nearest_word(entry.key, {key})) fail_unknown_key(entry);
  }
  throw CaseError(node_->place, fmt::format("key '{}': is missing, and has no default", full_key(key)));
}

void TableReader::set_default(const std::string& key, CaseNode&& value, const std::string& comment) {
  value.comment = comment;
  node_->table()->push_back({key, {}, std::move(value), true});
}

double TableReader::to_number(const std::string& key, const CaseNode& node, const Range& range) const {
  const auto* integer = std::get_if<int64_t>(&node.value);
  const auto* real = std::get_if<double>(&node.value);
  if (!integer && !real) fail_type(key, node, fmt::format("a number, {}", to_string(range)));
  const double value = real ? *real : static_cast<double>(*integer);
  if (holds(range, value)) return value;
  throw CaseError(node.place, fmt::format("key '{}': {} is out of range, must be {}", full_key(key), inline_toml(node),
                                          to_string(range)));
}

double TableReader::number(const std::string& key, const Range& range) { return to_number(key, require(key), range); }

double TableReader::number(const std::string& key, const Range& range, double fallback) {
  if (!has(key)) {
    set_default(key, node_of(fallback));
    return fallback;
  }
  return number(key, range);
}

uint64_t TableReader::whole(const std::string& key, const Range& range) {
  const CaseNode& node = require(key);
  const double value = to_number(key, node, range);
  if (value != std::floor(value)) fail_type(key, node, fmt::format("a whole number, {}", to_string(range)));
  const auto* integer = std::get_if<int64_t>(&node.value);
  return integer ? static_cast<uint64_t>(*integer) : static_cast<uint64_t>(value);
}

uint64_t TableReader::whole(const std::string& key, const Range& range, uint64_t fallback) {
  if (!has(key)) set_default(key, {static_cast<int64_t>(fallback), {}, {}});
  return whole(key, range);
}

bool TableReader::flag(const std::string& key, bool fallback) {
  if (!has(key)) set_default(key, {fallback, {}, {}});
  const CaseNode& node = require(key);
  const bool* value = std::get_if<bool>(&node.value);
  if (!value) fail_type(key, node, "true or false");
  return *value;
}

std::string TableReader::text(const std::string& key) {
  const CaseNode& node = require(key);
  if (!node.text()) fail_type(key, node, "a string");
  if (node.text()->empty() && key != "title") fail(key, "\"\" is empty, must be a word");
  return *node.text();
}

std::string TableReader::text(const std::string& key, const std::string& fallback) {
  if (!has(key)) set_default(key, node_of(fallback));
  return text(key);
}

std::string TableReader::name(const std::string& key) {
  const std::string word = text(key);
  const bool plain =
      std::all_of(word.begin(), word.end(), [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; });
  if (!plain) fail(key, fmt::format("'{}' is not a name, must be made of letters, digits, _ and -", word));
  return word;
}

std::string TableReader::name(const std::string& key, const std::string& fallback) {
  text(key, fallback);
  return name(key);
}

std::vector<double> TableReader::to_numbers(const std::string& key, const CaseNode& node, const Range& range,
                                            size_t size) const {
  const CaseNode::Array* array = node.array();
  const std::string wanted = size ? fmt::format("a list of {} numbers, each {}", size, to_string(range))
                                  : fmt::format("a list of numbers, each {}", to_string(range));
  if (!array) fail_type(key, node, wanted);
  if (array->empty() || (size && array->size() != size)) {
    throw CaseError(node.place, fmt::format("key '{}': {} has {} entries, must be {}", full_key(key),
                                            shortened(inline_toml(node)), array->size(), wanted));
  }
  std::vector<double> result;
  for (const CaseNode& element : *array) result.push_back(to_number(key, element, range));
  return result;
}

std::vector<double> TableReader::numbers(const std::string& key, const Range& range, size_t size) {
  return to_numbers(key, require(key), range, size);
}

std::vector<double> TableReader::whole_numbers(const std::string& key, const Range& range, size_t size) {
  const std::vector<double> result = numbers(key, range, size);
  const bool whole = std::all_of(result.begin(), result.end(), [](double v) { return v == std::floor(v); });
  if (!whole) fail_type(key, require(key), fmt::format("a list of {} whole numbers, each {}", size, to_string(range)));
  return result;
}

Vec3 TableReader::vec3(const std::string& key, const Range& range) {
  const std::vector<double> v = numbers(key, range, 3);
  return {v[0], v[1], v[2]};
}

Vec3 TableReader::vec3(const std::string& key, const Range& range, const Vec3& fallback) {
  if (!has(key)) set_default(key, node_of(fallback));
  return vec3(key, range);
}

Vec3 TableReader::direction(const std::string& key) {
  const Vec3 v = vec3(key, Range{});
  const double length = norm(v);
  if (!(length > 1e-100) || !std::isfinite(length)) {
    fail(key, fmt::format("{} has no direction, must not be zero", shown(key)));
  }
  return unit(v);
}

Vec3 TableReader::direction(const std::string& key, const Vec3& fallback) {
  vec3(key, Range{}, fallback);
  return direction(key);
}

std::vector<std::vector<double>> TableReader::rows(const std::string& key, const Range& range, size_t size) {
  const CaseNode& node = require(key);
  if (!node.array()) fail_type(key, node, fmt::format("a list of lists of {} numbers", size));
  if (node.array()->empty()) fail(key, fmt::format("[] is empty, must be lists of {} numbers", size));
  std::vector<std::vector<double>> result;
  for (const CaseNode& row : *node.array()) result.push_back(to_numbers(key, row, range, size));
  return result;
}

std::vector<std::string> TableReader::texts(const std::string& key) {
  const CaseNode& node = require(key);
  if (node.text()) return {text(key)};
  if (!node.array()) fail_type(key, node, "a string or a list of strings");
  if (node.array()->empty()) fail(key, "[] is empty, must hold at least one name");
  std::vector<std::string> result;
  for (const CaseNode& element : *node.array()) {
    if (!element.text()) fail_type(key, element, "a string");
    if (std::find(result.begin(), result.end(), *element.text()) != result.end()) {
      throw CaseError(element.place, fmt::format("key '{}': '{}' is named twice", full_key(key), *element.text()));
    }
    result.push_back(*element.text());
  }
  return result;
}

std::vector<std::string> TableReader::texts(const std::string& key, const std::vector<std::string>& fallback) {
  if (const CaseNode* node = find(key)) {
    const bool empty = node->array() && node->array()->empty();
    return empty && fallback.empty() ? fallback : texts(key);
  }
  CaseNode::Array names;
  for (const std::string& name : fallback) names.push_back(node_of(name));
  set_default(key, {std::move(names), {}, {}});
  return fallback;
}

std::vector<std::string> TableReader::pair_of_texts(const std::string& key) {
  const CaseNode& node = require(key);
  const CaseNode::Array* array = node.array();
  if (!array || array->size() != 2 || !(*array)[0].text() || !(*array)[1].text()) {
    fail_type(key, node, "a list of two names");
  }
  return {*(*array)[0].text(), *(*array)[1].text()};
}

uint32_t TableReader::index_of(const std::string& key, const std::string& word, const std::string& what,
                               const std::vector<std::string>& names) {
  const auto found = std::find(names.begin(), names.end(), word);
  if (found == names.end()) fail_unknown(key, word, what, names);
  return static_cast<uint32_t>(found - names.begin());
}

uint32_t TableReader::index(const std::string& key, const std::string& what, const std::vector<std::string>& names) {
  return index_of(key, text(key), what, names);
}

TableReader TableReader::table(const std::string& key) {
  if (!has(key)) set_default(key, {CaseNode::Table{}, {}, {}}, "");
  CaseNode& node = require(key);
  if (!node.table()) fail_type(key, node, "a table");
  if (node.place.file.empty()) node.place = node_->place;
  return TableReader(node, full_key(key));
}

std::vector<TableReader> TableReader::tables(const std::string& key) {
  CaseNode* node = find(key);
  if (!node) return {};
  if (!is_table_array(*node)) {
    if (node->array() && node->array()->empty()) fail(key, "[] is empty, leave the key out or give at least one");
    fail_type(key, *node, fmt::format("tables, each under [[{}]]", key));
  }
  if (node->array()->size() > kMostTables)
    fail(key, fmt::format("{} tables, must be at most {}; many fibres go into a CSV file: [[fibres]] file = \"...\"",
                          node->array()->size(), kMostTables));
  std::vector<TableReader> result;
  for (CaseNode& element : *node->array()) {
    const std::string label = element_label(key, element);
    const size_t number = result.size() + 1;
    result.emplace_back(element, full_key(key) + (label.empty() ? fmt::format("[{}]", number) : "." + label));
  }
  return result;
}

TableReader TableReader::added_table(const std::string& key) {
  if (!has(key)) set_default(key, {CaseNode::Array{}, {}, {}}, "");
  CaseNode::Array& all = *require(key).array();
  all.push_back({CaseNode::Table{}, node_->place, {}});
  return TableReader(all.back(), full_key(key));
}

std::pair<std::vector<std::string>, std::vector<double>> TableReader::weights(const std::string& key) {
  CaseNode& node = require(key);
  if (!node.table()) fail_type(key, node, "a table {name = fraction, ...}");
  if (node.table()->empty()) fail(key, "{} is empty, must hold at least one name");
  std::pair<std::vector<std::string>, std::vector<double>> result;
  for (const CaseEntry& entry : *node.table()) {
    result.first.push_back(entry.key);
    result.second.push_back(to_number(key + "." + entry.key, entry.node, positive(1, "")));
  }
  return result;
}

std::string TableReader::one_of(const std::vector<std::string>& keys) {
  const std::string given = at_most_one_of(keys);
  if (!given.empty()) return given;
  for (const CaseEntry& entry : *node_->table()) {
    if (!entry.used && nearest_word(entry.key, keys)) fail_unknown_key(entry);
  }
  const std::string advice =
      keys.size() == 1 ? "and has no default" : fmt::format("give one of: {}", fmt::join(keys, ", "));
  throw CaseError(node_->place, fmt::format("key '{}': is missing, {}", full_key(keys[0]), advice));
}

std::string TableReader::at_most_one_of(const std::vector<std::string>& keys) {
  std::string given;
  for (const std::string& key : keys) {
    if (!has(key)) continue;
    if (!given.empty()) {
      fail(key, fmt::format("{} contradicts '{}' = {}, give only one of: {}", shown(key), given, shown(given),
                            fmt::join(keys, ", ")));
    }
    given = key;
  }
  return given;
}

void TableReader::record(const std::string& key, const Vec3& value, const std::string& comment) {
  if (has(key)) return;
  set_default(key, node_of(value), comment);
}

void TableReader::comment(const std::string& key, const std::string& text) {
  if (CaseNode* node = find(key)) node->comment = text;
}

void TableReader::rewrite(const std::string& key, const std::string& text) { require(key).value = text; }

void TableReader::finish() {
  for (const CaseEntry& entry : *node_->table()) {
    if (!entry.used) fail_unknown_key(entry);
  }
}

}  // namespace scree
