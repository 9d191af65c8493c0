// Typed, checked values out of one table of a case file. Every key that is asked for counts as known; finish() refuses
// what nobody asked for. A default that is used is written into the tree, so that the tree ends as the case in full.
#pragma once

#include <limits>
#include <utility>

#include "geometry/vec.h"
#include "runtime/case_toml.h"

namespace scree {

// What a number may be. The unit is part of every error.
struct Range {
  double min = -std::numeric_limits<double>::max(), max = std::numeric_limits<double>::max();
  const char* unit = "";
  bool above_min = false;  // min itself is not allowed
};
inline constexpr Range between(double min, double max, const char* unit) { return {min, max, unit, false}; }
inline constexpr Range positive(double max, const char* unit) { return {0, max, unit, true}; }
inline constexpr Range kPosition = between(-1e3, 1e3, "m");
inline constexpr Range kLength = between(1e-9, 1e3, "m");
inline constexpr Range kDuration = positive(1e6, "s");
inline constexpr Range kVelocity = between(-1e3, 1e3, "m/s");

bool holds(const Range& range, double value);  // false for NaN
std::string to_string(const Range& range);

template <class E>
using Choices = std::vector<std::pair<const char*, E>>;

class TableReader {
 public:
  TableReader(CaseNode& node, std::string path) : node_(&node), path_(std::move(path)) {}

  bool has(const std::string& key) { return find(key) != nullptr; }
  double number(const std::string& key, const Range& range);
  double number(const std::string& key, const Range& range, double fallback);
  uint64_t whole(const std::string& key, const Range& range);
  uint64_t whole(const std::string& key, const Range& range, uint64_t fallback);
  bool flag(const std::string& key, bool fallback);
  std::string text(const std::string& key);
  std::string text(const std::string& key, const std::string& fallback);
  std::string name(const std::string& key = "name");  // letters, digits, _ and -
  std::string name(const std::string& key, const std::string& fallback);
  Vec3 vec3(const std::string& key, const Range& range);
  Vec3 vec3(const std::string& key, const Range& range, const Vec3& fallback);
  Vec3 direction(const std::string& key);  // made a unit vector
  Vec3 direction(const std::string& key, const Vec3& fallback);
  std::vector<double> numbers(const std::string& key, const Range& range, size_t size);  // size 0: one or more
  std::vector<double> whole_numbers(const std::string& key, const Range& range, size_t size);
  std::vector<std::vector<double>> rows(const std::string& key, const Range& range, size_t size);
  std::vector<std::string> texts(const std::string& key);  // one or more; a lone string is a list of one
  std::vector<std::string> texts(const std::string& key, const std::vector<std::string>& fallback);

  std::vector<std::string> pair_of_texts(const std::string& key);  // two, perhaps the same

  // One of the named values; the error lists them and the nearest.
  template <class E>
  E choice(const std::string& key, const Choices<E>& choices) {
    const std::string word = text(key);
    std::vector<std::string> names;
    for (const auto& [name, value] : choices) {
      if (word == name) return value;
      names.push_back(name);
    }
    fail_unknown(key, word, "value", names);
  }
  template <class E>
  E choice(const std::string& key, const Choices<E>& choices, const char* fallback) {
    text(key, fallback);
    return choice(key, choices);
  }
  // The index of a name in `names`.
  uint32_t index(const std::string& key, const std::string& what, const std::vector<std::string>& names);
  uint32_t index_of(const std::string& key, const std::string& word, const std::string& what,
                    const std::vector<std::string>& names);

  TableReader table(const std::string& key);                // made if it is not there
  std::vector<TableReader> tables(const std::string& key);  // the elements of [[key]]; none if it is not there
  TableReader added_table(const std::string& key);          // a default one more under [[key]]
  std::pair<std::vector<std::string>, std::vector<double>> weights(const std::string& key);  // {name = number, ...}

  // Exactly one of these keys must be there; returns it.
  std::string one_of(const std::vector<std::string>& keys);
  // At most one; empty if none.
  std::string at_most_one_of(const std::vector<std::string>& keys);

  // Writes what was worked out (not given) into the tree, with a comment.
  void record(const std::string& key, const Vec3& value, const std::string& comment);
  void comment(const std::string& key, const std::string& text);
  void rewrite(const std::string& key, const std::string& text);  // what was given, in full

  void finish();  // refuses unknown keys

  [[noreturn]] void fail(const std::string& key, const std::string& problem) const;
  [[noreturn]] void fail_unknown(const std::string& key, const std::string& word, const std::string& what,
                                 const std::vector<std::string>& known) const;
  std::string full_key(const std::string& key) const { return path_.empty() ? key : path_ + "." + key; }
  const std::string& path() const { return path_; }
  std::string shown(const std::string& key) const;  // the value as written
  SourcePlace place(const std::string& key) const;

 private:
  CaseNode* find(const std::string& key);
  CaseNode& require(const std::string& key);
  void set_default(const std::string& key, CaseNode&& value, const std::string& comment = "default");
  double to_number(const std::string& key, const CaseNode& node, const Range& range) const;
  std::vector<double> to_numbers(const std::string& key, const CaseNode& node, const Range& range, size_t size) const;
  [[noreturn]] void fail_type(const std::string& key, const CaseNode& node, const std::string& wanted) const;
  [[noreturn]] void fail_unknown_key(const CaseEntry& entry) const;

  CaseNode* node_;
  std::string path_;
  std::vector<std::string> known_;
};

}  // namespace scree
