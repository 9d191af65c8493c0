#include "runtime/csv_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include "runtime/case_toml.h"
#include "runtime/memory.h"

namespace scree {
namespace {

// A line of text becomes at most so many times its size: the text, the rows as numbers, and a vector that grows.
constexpr double kMemoryPerByte = 6;

std::string_view trimmed(std::string_view text) {
  const size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return text.substr(0, 0);
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::string read_whole(const std::string& path) {
  std::error_code error;
  std::ifstream stream(path, std::ios::binary);
  if (!stream || !std::filesystem::is_regular_file(path, error))
    throw CaseError({path, 0, 0}, "the file cannot be read");
  require_room_for_csv({path, 0, 0}, path);
  std::ostringstream text;
  text << stream.rdbuf();
  return std::move(text).str();
}

}  // namespace

void require_room_for_csv(const SourcePlace& place, const std::string& path) {
  std::error_code error;
  const auto bytes = static_cast<double>(std::filesystem::file_size(path, error));
  require_memory(place, fmt::format("reading {} of CSV needs", bytes_text(bytes)), kMemoryPerByte * bytes);
}

CsvTable::CsvTable(const std::string& path, const std::vector<std::string>& known)
    : CsvTable(path, read_whole(path), known) {}

CsvTable::CsvTable(const std::string& path, std::string text, const std::vector<std::string>& known)
    : path_(path), text_(std::move(text)) {
  if (!next_line(row_))
    throw CaseError({path_, 1, 1}, fmt::format("the file is empty, must begin with a line of column names ({})",
                                               fmt::join(known, ", ")));
  header_line_ = line_;
  split(row_);
  for (const std::string_view field : fields_) {
    const std::string name(field);
    const int column = static_cast<int>(names_.size());
    if (std::ranges::find(names_, name) != names_.end()) fail(column, fmt::format("column '{}' is there twice", name));
    if (std::ranges::find(known, name) == known.end()) {
      const auto near = nearest_word(name, known);
      fail(column, fmt::format("unknown column '{}', known: {}{}", name, fmt::join(known, ", "),
                               near ? fmt::format("; did you mean '{}'?", *near) : ""));
    }
    names_.push_back(name);
  }
}

int CsvTable::column(std::string_view name) const {
  const auto found = std::ranges::find(names_, name);
  return found == names_.end() ? -1 : static_cast<int>(found - names_.begin());
}

int CsvTable::require(std::string_view name) const {
  const int found = column(name);
  if (found < 0)
    throw CaseError({path_, header_line_, 1},
                    fmt::format("column '{}' is missing, there are: {}", name, fmt::join(names_, ", ")));
  return found;
}

bool CsvTable::next() {
  if (!next_line(row_)) return false;
  split(row_);
  if (fields_.size() != names_.size()) {
    throw CaseError({path_, line_, 1}, fmt::format("the line has {} fields, must be {} like the header: {}",
                                                   fields_.size(), names_.size(), fmt::join(names_, ", ")));
  }
  return true;
}

double CsvTable::number(int column, const Range& range) const {
  const std::string_view field = text(column);
  const char* const begin = field.data() + (field.starts_with('+') ? 1 : 0);
  const char* const end = field.data() + field.size();
  double value = 0;
  const auto [stop, error] = std::from_chars(begin, end, value);
  if (error != std::errc() || stop != end) fail(column, fmt::format("'{}' is not a number", field));
  if (!std::isfinite(value)) fail(column, fmt::format("'{}' is not a finite number", field));
  if (!holds(range, value)) fail(column, fmt::format("{} is out of range, must be {}", field, to_string(range)));
  return value;
}

void CsvTable::fail(int column, std::string_view problem) const {
  const std::string_view field = text(column);
  const int offset = static_cast<int>(field.data() - row_.data());
  const std::string name =
      column < static_cast<int>(names_.size()) ? fmt::format("column '{}': ", names_[static_cast<size_t>(column)]) : "";
  throw CaseError({path_, line_, offset + 1}, name + std::string(problem));
}

bool CsvTable::next_line(std::string_view& line) {
  while (position_ < text_.size()) {
    const size_t end = std::min(text_.find('\n', position_), text_.size());
    line = std::string_view(text_).substr(position_, end - position_);
    position_ = end + 1;
    if (line_ == std::numeric_limits<int>::max())
      throw CaseError({path_, line_, 1}, fmt::format("the file has more than {} lines", line_));
    ++line_;
    const std::string_view content = trimmed(line);
    if (!content.empty() && content[0] != '#') return true;
  }
  return false;
}

void CsvTable::split(std::string_view line) {
  fields_.clear();
  for (size_t begin = 0;;) {
    const size_t comma = std::min(line.find(',', begin), line.size());
    fields_.push_back(trimmed(line.substr(begin, comma - begin)));
    if (comma == line.size()) return;
    begin = comma + 1;
  }
}

}  // namespace scree
