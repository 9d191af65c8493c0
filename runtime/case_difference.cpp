#include "runtime/case_difference.h"

#include <algorithm>
#include <array>

#include "runtime/case_toml.h"

namespace scree {

namespace {

// Field files and pictures that were written before a change stay as they are; later ones follow the case as it is now.
constexpr std::array kHarmless{
    "title", "output.final_vtk", "output.picture", "output.fields", "output.residence.bin", "checkpoint", "watch"};

using Difference = std::optional<std::string>;

bool is_harmless(const std::string& key) { return std::ranges::find(kHarmless, key) != kHarmless.end(); }

std::optional<double> number(const CaseNode& node) {
  if (const auto* real = std::get_if<double>(&node.value)) return *real;
  if (const auto* whole = std::get_if<int64_t>(&node.value)) return static_cast<double>(*whole);
  return std::nullopt;
}

bool same_value(const CaseNode& a, const CaseNode& b) {
  if (a.value.index() != b.value.index()) return number(a) && number(a) == number(b);  // 3 and 3.0
  return inline_toml(a) == inline_toml(b);
}

std::string joined(const std::string& path, const std::string& key) { return path.empty() ? key : path + "." + key; }

std::string changed(const std::string& key, const CaseNode* before, const CaseNode* now) {
  if (!before) return fmt::format("key '{}' = {} is new", key, inline_toml(*now));
  if (!now) return fmt::format("key '{}' = {} is gone", key, inline_toml(*before));
  return fmt::format("key '{}' was {} and is now {}", key, inline_toml(*before), inline_toml(*now));
}

Difference compare_tables(const std::string& path, const CaseNode& before, const CaseNode& now);

Difference compare_elements(const std::string& key, const CaseNode& before, const CaseNode& now) {
  const auto &a = *before.array(), &b = *now.array();
  for (size_t k = 0; k < std::min(a.size(), b.size()); ++k) {
    const std::string old_label = element_label(key, a[k]), label = element_label(key, b[k]);
    if (old_label != label) return fmt::format("the {}. '{}' was '{}' and is now '{}'", k + 1, key, old_label, label);
    if (auto d = compare_tables(joined(key, label.empty() ? std::to_string(k + 1) : label), a[k], b[k])) return d;
  }
  if (a.size() == b.size()) return std::nullopt;
  return fmt::format("the number of '{}' was {} and is now {}", key, a.size(), b.size());
}

Difference compare_nodes(const std::string& key, const CaseNode& before, const CaseNode& now) {
  if (before.table() && now.table()) return compare_tables(key, before, now);
  if (is_table_array(before) && is_table_array(now)) return compare_elements(key, before, now);
  if (same_value(before, now)) return std::nullopt;
  return changed(key, &before, &now);
}

Difference compare_tables(const std::string& path, const CaseNode& before, const CaseNode& now) {
  for (const CaseEntry& entry : *before.table()) {
    const std::string key = joined(path, entry.key);
    if (is_harmless(key)) continue;
    const CaseEntry* other = find_entry(now, entry.key);
    if (!other) return changed(key, &entry.node, nullptr);
    if (auto d = compare_nodes(key, entry.node, other->node)) return d;
  }
  for (const CaseEntry& entry : *now.table()) {
    const std::string key = joined(path, entry.key);
    if (!is_harmless(key) && !find_entry(before, entry.key)) return changed(key, nullptr, &entry.node);
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> case_difference(const std::string& before, const std::string& now) {
  if (before == now) return std::nullopt;
  return compare_tables("", parse_case_text(before, "checkpoint"), parse_case_text(now, "case"));
}

}  // namespace scree
