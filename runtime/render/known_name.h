// Refusing a name that is not known, with the names that are and the nearest.
#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "runtime/case_toml.h"

namespace scree {

[[noreturn]] inline void fail_unknown_name(const std::string& what, const std::string& word,
                                           const std::vector<std::string>& known) {
  const auto near = nearest_word(word, known);
  throw std::invalid_argument(fmt::format("unknown {} '{}', known: {}{}", what, word, fmt::join(known, ", "),
                                          near ? fmt::format("; did you mean '{}'?", *near) : ""));
}

}  // namespace scree
