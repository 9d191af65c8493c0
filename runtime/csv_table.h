// A CSV file as lines of fields: one header line of column names, '#' comments and empty lines skipped, no quotes.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "runtime/case_error.h"
#include "runtime/case_table.h"

namespace scree {

// Throws CaseError if the file is larger than can be read into the memory that there is.
void require_room_for_csv(const SourcePlace& place, const std::string& path);

class CsvTable {
 public:
  // Reads the file and its header. Every column must be in `known`; a name twice is refused.
  CsvTable(const std::string& path, const std::vector<std::string>& known);
  CsvTable(const std::string& path, std::string text, const std::vector<std::string>& known);  // with its text at hand
  CsvTable(const CsvTable&) = delete;  // its fields are views of its text

  int column(std::string_view name) const;   // -1: not there
  int require(std::string_view name) const;  // throws if not there

  bool next();                                          // to the next row; throws if its number of fields is wrong
  double number(int column, const Range& range) const;  // throws if it is not finite or out of range
  std::string_view text(int column) const { return fields_[static_cast<size_t>(column)]; }
  int line() const { return line_; }

  [[noreturn]] void fail(int column, std::string_view problem) const;  // at the field of this row

 private:
  bool next_line(std::string_view& line);
  void split(std::string_view line);

  std::string path_, text_;
  size_t position_ = 0;
  int line_ = 0, header_line_ = 0;
  std::string_view row_;
  std::vector<std::string_view> fields_;
  std::vector<std::string> names_;
};

}  // namespace scree
