// Refusing a name that is not known, with the names that are and the nearest.
#pragma once

#include "runtime/case_error.h"
#include "runtime/case_toml.h"

namespace scree {

// `place`: where the name was given, e.g. "--camera".
[[noreturn]] inline void fail_unknown_name(const std::string& place, const std::string& what, const std::string& word,
                                           const std::vector<std::string>& known) {
  const auto near = nearest_word(word, known);
  throw CaseError({place}, fmt::format("unknown {} '{}', known: {}{}", what, word, fmt::join(known, ", "),
                                       near ? fmt::format("; did you mean '{}'?", *near) : ""));
}

}  // namespace scree
