// Looking things up in a case tree, and writing it as TOML.
#include <algorithm>
#include <numeric>

#include "runtime/case_toml.h"

namespace scree {
namespace {

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      out += fmt::format("\\u{:04x}", static_cast<unsigned char>(c));
    } else {
      out += c;
    }
  }
  return out + '"';
}

std::string number_text(double value) {
  const std::string text = fmt::format("{}", value);  // the shortest that reads back to the same bits
  return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
}

std::string key_text(const std::string& key) {
  const bool bare = !key.empty() && std::all_of(key.begin(), key.end(), [](unsigned char c) {
    return std::isalnum(c) || c == '_' || c == '-';
  });
  return bare ? key : quoted(key);
}

bool has_section(const CaseEntry& entry) { return entry.node.table() || is_table_array(entry.node); }

void emit_values(const CaseNode& table, std::string& out) {
  for (const CaseEntry& entry : *table.table()) {
    out += fmt::format("{} = {}", key_text(entry.key), inline_toml(entry.node));
    out += entry.node.comment.empty() ? "\n" : fmt::format("  # {}\n", entry.node.comment);
  }
}

std::string element_of_pair(const CaseNode& element) {
  const CaseEntry* materials = find_entry(element, "materials");
  const CaseNode::Array* names = materials ? materials->node.array() : nullptr;
  if (!names || names->size() != 2 || !(*names)[0].text() || !(*names)[1].text()) return "";
  const auto [first, second] = std::minmax(*(*names)[0].text(), *(*names)[1].text());
  return first + "+" + second;
}

// Optimal string alignment distance: insertions, deletions, substitutions and swaps of neighbours.
size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<size_t>> d(a.size() + 1, std::vector<size_t>(b.size() + 1));
  for (size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  std::iota(d[0].begin(), d[0].end(), size_t{0});
  for (size_t i = 1; i <= a.size(); ++i) {
    for (size_t j = 1; j <= b.size(); ++j) {
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  }
  return d[a.size()][b.size()];
}

}  // namespace

CaseEntry* find_entry(CaseNode& table, std::string_view key) {
  auto& entries = *table.table();
  const auto found = std::find_if(entries.begin(), entries.end(), [&](const CaseEntry& e) { return e.key == key; });
  return found == entries.end() ? nullptr : &*found;
}

const CaseEntry* find_entry(const CaseNode& table, std::string_view key) {
  return find_entry(const_cast<CaseNode&>(table), key);
}

bool is_table_array(const CaseNode& node) {
  const CaseNode::Array* array = node.array();
  return array && !array->empty() &&
         std::all_of(array->begin(), array->end(), [](const CaseNode& element) { return element.table(); });
}

std::string element_label(std::string_view array_key, const CaseNode& element) {
  if (array_key == "pair") return element_of_pair(element);
  for (const char* key : {"name", "kind"}) {
    const CaseEntry* entry = find_entry(element, key);
    if (entry && entry->node.text()) return *entry->node.text();
    if (array_key != "stage") break;
  }
  return "";
}

std::string inline_toml(const CaseNode& node) {
  struct Print {
    std::string operator()(bool value) const { return value ? "true" : "false"; }
    std::string operator()(int64_t value) const { return fmt::format("{}", value); }
    std::string operator()(double value) const { return number_text(value); }
    std::string operator()(const std::string& value) const { return quoted(value); }
    std::string operator()(const CaseNode::Array& value) const {
      std::vector<std::string> parts;
      for (const CaseNode& element : value) parts.push_back(inline_toml(element));
      return fmt::format("[{}]", fmt::join(parts, ", "));
    }
    std::string operator()(const CaseNode::Table& value) const {
      std::vector<std::string> parts;
      for (const CaseEntry& e : value) parts.push_back(fmt::format("{} = {}", key_text(e.key), inline_toml(e.node)));
      return fmt::format("{{{}}}", fmt::join(parts, ", "));
    }
  };
  return std::visit(Print{}, node.value);
}

std::string emit_toml(const CaseNode& tree) {
  std::string out;
  CaseNode values = tree;
  values.table()->remove_if(has_section);
  emit_values(values, out);
  for (const CaseEntry& entry : *tree.table()) {
    if (entry.node.table()) {
      out += fmt::format("\n[{}]\n", key_text(entry.key));
      emit_values(entry.node, out);
    } else if (is_table_array(entry.node)) {
      for (const CaseNode& element : *entry.node.array()) {
        out += fmt::format("\n[[{}]]\n", key_text(entry.key));
        emit_values(element, out);
      }
    }
  }
  return out;
}

std::optional<std::string> nearest_word(std::string_view word, const std::vector<std::string>& candidates) {
  constexpr size_t kLongestWord = 100;  // a longer one is no slip of the pen, and distances cost its length squared
  if (word.size() > kLongestWord) return std::nullopt;
  std::optional<std::string> best;
  size_t least = std::max<size_t>(2, word.size() / 3) + 1;
  for (const std::string& candidate : candidates) {
    if (candidate.size() > kLongestWord) continue;
    const size_t distance = edit_distance(word, candidate);
    if (distance < least && distance < std::max(word.size(), candidate.size())) {
      least = distance;
      best = candidate;
    }
  }
  return best;
}

}  // namespace scree
