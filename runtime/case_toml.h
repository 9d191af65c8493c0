// A case file as a tree of values that remember where they were written. load_case_tree() reads the TOML, its bases and
// the overrides into one tree; case_table.h takes typed values out of it; emit_toml() writes it back as TOML.
// case_toml.cpp is the only file that includes toml++.
#pragma once

#include <cstdint>
#include <list>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "runtime/case_error.h"

namespace scree {

struct CaseEntry;

struct CaseNode {
  using Array = std::vector<CaseNode>;
  using Table = std::list<CaseEntry>;  // in the order of the file; a list, so that adding a default moves nothing
  std::variant<bool, int64_t, double, std::string, Array, Table> value;
  SourcePlace place;
  std::string comment;  // written behind the value by emit_toml()

  Array* array() { return std::get_if<Array>(&value); }
  const Array* array() const { return std::get_if<Array>(&value); }
  Table* table() { return std::get_if<Table>(&value); }
  const Table* table() const { return std::get_if<Table>(&value); }
  const std::string* text() const { return std::get_if<std::string>(&value); }
};

struct CaseEntry {
  std::string key;
  SourcePlace place;  // of the key
  CaseNode node;
  bool used = false;  // asked for by a reader
};

CaseEntry* find_entry(CaseNode& table, std::string_view key);
const CaseEntry* find_entry(const CaseNode& table, std::string_view key);
bool is_table_array(const CaseNode& node);

// How an element of an array of tables is addressed in overrides and errors: its name; a pair's materials as "a+b";
// a stage without a name by its kind. Empty if it has none of these.
std::string element_label(std::string_view array_key, const CaseNode& element);

// Reads `path`: first its `base` files (a string or a list, relative to the file that names them, each merged once),
// then the file itself, then the overrides "key.path=value". Later wins: tables merge deeply; arrays of tables merge by
// element_label(); `stage` is replaced as a whole; an element whose `kind` or `shape` changes is replaced as a whole;
// and one key of a choice (fibre_diameter | porosity, step | rayleigh_fraction, ...) replaces the other.
// Throws CaseError.
CaseNode load_case_tree(const std::string& path, const std::vector<std::string>& overrides);

// One file's text alone; `file` names it in errors. Throws CaseError.
CaseNode parse_case_text(const std::string& text, const std::string& file);
// The same with the text of the file at hand.
CaseNode load_case_tree(const std::string& text, const std::string& path, const std::vector<std::string>& overrides);

// The value as TOML in one line.
std::string inline_toml(const CaseNode& node);

// A whole tree as TOML text that load_case_tree() reads back.
std::string emit_toml(const CaseNode& tree);

// The candidate with the fewest edits, if it is near enough to be a slip of the pen.
std::optional<std::string> nearest_word(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace scree
