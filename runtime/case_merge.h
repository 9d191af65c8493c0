// How case files combine: a later tree is laid over an earlier one. The rules stand at load_case_tree() in case_toml.h.
#pragma once

#include "runtime/case_toml.h"

namespace scree {

// Lays `over` (a table) over `under` (a table).
void merge_tables(CaseNode& under, CaseNode&& over);

// Puts `value` where the dotted path leads: through tables by key, through arrays of tables by element_label().
// Tables on the way are made; an element that does not exist is a CaseError at `place`.
void set_at_path(CaseNode& tree, const std::string& path, CaseNode&& value, const SourcePlace& place);

// Says of a whole tree that it was written at `place`.
void set_places(CaseNode& node, const SourcePlace& place);

}  // namespace scree
