// The one error of reading a user's files. what() is complete: "file:line:column: key 'x.y': what is wrong (value),
// what is allowed with its unit; did you mean 'z'?"
#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <string_view>

namespace scree {

// Where something was written. line 0: not in a file, `file` says where (an override of the command line).
struct SourcePlace {
  std::string file;
  int line = 0, column = 0;
};

inline std::string to_string(const SourcePlace& place) {
  return place.line > 0 ? fmt::format("{}:{}:{}", place.file, place.line, place.column) : place.file;
}

class CaseError : public std::runtime_error {
 public:
  CaseError(const SourcePlace& place, std::string_view problem)
      : std::runtime_error(fmt::format("{}: {}", to_string(place), problem)) {}
};

}  // namespace scree
