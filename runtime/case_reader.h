// From a case file to a Case. Lists of every key: the commented files in cases/examples.
#pragma once

#include <string>
#include <vector>

#include "runtime/case.h"
#include "runtime/case_error.h"

namespace scree {

// Reads and checks a case file, its bases and the overrides "key.path=value" laid over it ("contact.rolling=cdt",
// "material.steel.density=7800", "pair.grain+steel.restitution=0.4"). Nothing is ignored: every key is known, in range
// and used, or a CaseError says where it stands and what is allowed.
Case read_case(const std::string& path, const std::vector<std::string>& overrides = {});

// The same from text; `path` is where it would stand: for messages, and files that it names are looked up beside it.
Case read_case_text(const std::string& text, const std::string& path, const std::vector<std::string>& overrides = {});

}  // namespace scree
