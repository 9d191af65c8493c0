#include "runtime/case_merge.h"

#include <algorithm>

namespace scree {
namespace {

// Of these only one may be given; giving one later takes the earlier one back.
const std::vector<std::vector<std::string>> kChoices = {
    {"fibre_diameter", "porosity"}, {"step", "rayleigh_fraction"}, {"mass", "count"},
    {"diameter", "distribution"},   {"particles", "mixture"},      {"segments", "file"},
};

void drop_replaced_choices(CaseNode& under, const CaseNode& over) {
  for (const auto& choice : kChoices) {
    const auto given = [&](const std::string& key) { return find_entry(over, key) != nullptr; };
    if (std::none_of(choice.begin(), choice.end(), given)) continue;
    under.table()->remove_if([&](const CaseEntry& entry) {
      return std::find(choice.begin(), choice.end(), entry.key) != choice.end() && !given(entry.key);
    });
  }
}

bool changes_kind(const CaseNode& under, const CaseNode& over) {
  for (const char* key : {"kind", "shape"}) {
    const CaseEntry *before = find_entry(under, key), *after = find_entry(over, key);
    if (before && after && inline_toml(before->node) != inline_toml(after->node)) return true;
  }
  return false;
}

CaseNode* find_element(CaseNode::Array& array, std::string_view array_key, const std::string& label) {
  const size_t plus = label.find('+');
  const std::string turned = plus == label.npos ? label : label.substr(plus + 1) + "+" + label.substr(0, plus);
  const auto found = std::find_if(array.begin(), array.end(), [&](const CaseNode& node) {
    const std::string own = element_label(array_key, node);
    return own == label || own == turned;
  });
  return found == array.end() || label.empty() ? nullptr : &*found;
}

void merge_elements(std::string_view array_key, CaseNode::Array& under, CaseNode::Array&& over) {
  const size_t before = under.size();  // two new elements of one name stay two: the reader reports them
  for (CaseNode& element : over) {
    CaseNode::Array::iterator end = under.begin() + static_cast<std::ptrdiff_t>(before);
    const std::string label = element_label(array_key, element);
    const auto same = std::find_if(under.begin(), end, [&](const CaseNode& node) {
      return !label.empty() && element_label(array_key, node) == label;
    });
    if (same == end) {
      under.push_back(std::move(element));
    } else if (changes_kind(*same, element)) {
      *same = std::move(element);
    } else {
      merge_tables(*same, std::move(element));
    }
  }
}

void merge_entry(CaseNode& under, CaseEntry&& entry) {
  CaseEntry* same = find_entry(under, entry.key);
  if (!same) {
    under.table()->push_back(std::move(entry));
  } else if (same->node.table() && entry.node.table() && !changes_kind(same->node, entry.node)) {
    merge_tables(same->node, std::move(entry.node));
  } else if (entry.key != "stage" && is_table_array(same->node) && is_table_array(entry.node)) {
    merge_elements(entry.key, *same->node.array(), std::move(*entry.node.array()));
  } else {
    *same = std::move(entry);
  }
}

[[noreturn]] void fail_no_element(const CaseNode::Array& array, const std::string& key, const std::string& label,
                                  const SourcePlace& place) {
  std::vector<std::string> labels;
  for (const CaseNode& element : array) labels.push_back(element_label(key, element));
  const auto near = nearest_word(label, labels);
  throw CaseError(place, fmt::format("key '{}.{}': there is no such {}, known: {}{}", key, label, key,
                                     fmt::join(labels, ", "), near ? fmt::format("; did you mean '{}'?", *near) : ""));
}

}  // namespace

void merge_tables(CaseNode& under, CaseNode&& over) {
  drop_replaced_choices(under, over);
  if (over.place.line > 0) under.place = over.place;
  for (CaseEntry& entry : *over.table()) merge_entry(under, std::move(entry));
}

void set_at_path(CaseNode& tree, const std::string& path, CaseNode&& value, const SourcePlace& place) {
  const size_t dot = path.find('.');
  const std::string key = path.substr(0, dot);
  if (key.empty()) throw CaseError(place, "an empty part in the key path");
  if (!tree.table()) throw CaseError(place, fmt::format("key '{}': is not inside a table", path));
  if (dot == std::string::npos) {
    CaseNode over;
    over.value = CaseNode::Table{};
    over.table()->push_back({key, place, std::move(value), false});
    merge_tables(tree, std::move(over));
    return;
  }
  const std::string rest = path.substr(dot + 1);
  CaseEntry* entry = find_entry(tree, key);
  if (!entry) {
    CaseNode fresh;
    fresh.value = CaseNode::Table{};
    fresh.place = place;
    tree.table()->push_back({key, place, std::move(fresh), false});
    entry = &tree.table()->back();
  }
  if (!is_table_array(entry->node)) return set_at_path(entry->node, rest, std::move(value), place);
  const size_t next = rest.find('.');
  const std::string label = rest.substr(0, next);
  CaseNode* element = find_element(*entry->node.array(), key, label);
  if (!element) fail_no_element(*entry->node.array(), key, label, place);
  if (next == std::string::npos)
    throw CaseError(place, fmt::format("key '{}': names a whole {}, add the key to set", path, key));
  set_at_path(*element, rest.substr(next + 1), std::move(value), place);
}

void set_places(CaseNode& node, const SourcePlace& place) {
  node.place = place;
  if (node.array()) {
    for (CaseNode& element : *node.array()) set_places(element, place);
  }
  if (node.table()) {
    for (CaseEntry& entry : *node.table()) {
      entry.place = place;
      set_places(entry.node, place);
    }
  }
}

}  // namespace scree
