#include "runtime/report_data.h"

#include <algorithm>
#include <charconv>
#include <fstream>

#include "runtime/case_toml.h"
#include "runtime/report_pictures.h"
#include "runtime/run_folder.h"

namespace scree {

namespace {

namespace fs = std::filesystem;

constexpr size_t kMostRows = 4000;  // of a table in the page: more than a screen has columns
// The tables that the page shows, by how their names begin; others may be as long as the surface has patches.
constexpr const char* kTables[] = {"mass_flow", "meters", "residence", "retained"};
constexpr size_t kMostFiles = 2000;  // in the list

ReportJson to_json(const CaseNode& node) {
  struct Convert {
    ReportJson operator()(bool v) const { return v; }
    ReportJson operator()(int64_t v) const { return v; }
    ReportJson operator()(double v) const { return v; }
    ReportJson operator()(const std::string& v) const { return v; }
    ReportJson operator()(const CaseNode::Array& v) const {
      ReportJson array = ReportJson::array();
      for (const CaseNode& element : v) array.push_back(to_json(element));
      return array;
    }
    ReportJson operator()(const CaseNode::Table& v) const {
      ReportJson object = ReportJson::object();
      for (const CaseEntry& entry : v) object[entry.key] = to_json(entry.node);
      return object;
    }
  };
  return std::visit(Convert{}, node.value);
}

ReportJson cell(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() ? ReportJson(value) : ReportJson(text);
}

std::vector<std::string_view> fields_of(std::string_view line) {
  std::vector<std::string_view> fields;
  for (size_t from = 0, to = 0; to != line.npos; from = to + 1) {
    to = line.find(',', from);
    std::string_view field = line.substr(from, to == line.npos ? to : to - from);
    while (!field.empty() && field.front() == ' ') field.remove_prefix(1);
    while (!field.empty() && (field.back() == ' ' || field.back() == '\r')) field.remove_suffix(1);
    fields.push_back(field);
  }
  return fields;
}

bool next_row(std::ifstream& stream, std::string& line) {
  while (std::getline(stream, line))
    if (!line.empty() && line[0] != '#' && line[0] != '\r') return true;
  return false;
}

bool is_shown(const std::string& stem) {
  return std::ranges::any_of(kTables, [&](const char* table) { return stem.starts_with(table); });
}

ReportJson tables_of(const fs::path& folder) {
  ReportJson tables = ReportJson::object();
  for (const fs::path& file : entries_of(folder)) {
    if (file.extension() != ".csv" || !is_shown(file.stem().string())) continue;
    if (ReportJson table = csv_columns(file); !table.is_null()) tables[file.stem().string()] = std::move(table);
  }
  return tables;
}

ReportJson files_of(const fs::path& folder) {
  std::vector<std::pair<std::string, uint64_t>> found;
  std::error_code error;
  for (fs::recursive_directory_iterator at(folder, error), end; !error && at != end && found.size() < kMostFiles;
       at.increment(error)) {
    if (!at->is_regular_file(error) || at->path().filename() == "lock") continue;
    const uint64_t bytes = at->file_size(error);
    found.emplace_back(at->path().lexically_relative(folder).string(), error ? 0 : bytes);
  }
  std::sort(found.begin(), found.end());
  ReportJson files = ReportJson::array();
  for (const auto& [file, bytes] : found) files.push_back({{"file", file}, {"bytes", bytes}});
  return files;
}

ReportJson summary_of(const fs::path& folder) {
  std::ifstream stream(folder / "summary.json");
  ReportJson summary = ReportJson::parse(stream, nullptr, false);
  return summary.is_object() ? summary : ReportJson();
}

ReportJson case_of(const fs::path& folder) {
  try {
    return to_json(load_case_tree((folder / "case.toml").string(), {}));
  } catch (const CaseError&) {
    return ReportJson();
  }
}

}  // namespace

ReportJson csv_columns(const fs::path& path) {
  std::ifstream count(path), stream(path);
  std::string line;
  size_t rows = 0;
  if (!next_row(count, line)) return ReportJson();
  while (next_row(count, line)) ++rows;
  const size_t every = (rows + kMostRows - 1) / kMostRows;

  next_row(stream, line);
  const std::vector<std::string_view> names = fields_of(line);
  ReportJson columns = ReportJson::array(), data = ReportJson::array();
  for (const std::string_view name : names) columns.push_back(name), data.push_back(ReportJson::array());
  for (size_t k = 0; k < rows && next_row(stream, line); ++k) {
    if (k % every != 0 && k + 1 != rows) continue;
    const std::vector<std::string_view> fields = fields_of(line);
    if (fields.size() != data.size()) continue;  // the last row of a run that is being written, or was killed
    for (size_t j = 0; j < fields.size(); ++j) data[j].push_back(cell(fields[j]));
  }
  return {{"columns", std::move(columns)}, {"data", std::move(data)}, {"every", every}, {"rows", rows}};
}

ReportJson run_data(const fs::path& folder, const fs::path& page_folder, const PictureBudget& budget) {
  const fs::path full = fs::absolute(folder).lexically_normal();
  const fs::path named = full.filename().empty() ? full.parent_path() : full;  // "results/demo/" ends in a slash
  ReportJson run;
  run["name"] = named.filename().string();
  run["path"] = named.string();
  run["link"] = named.lexically_relative(fs::absolute(page_folder).lexically_normal()).string();
  if (ReportJson summary = summary_of(folder); !summary.is_null()) run["summary"] = std::move(summary);
  if (ReportJson understood = case_of(folder); !understood.is_null()) run["case"] = std::move(understood);
  run["tables"] = tables_of(folder);
  run["pictures"] = pictures_of(folder, budget);
  run["files"] = files_of(folder);
  return run;
}

}  // namespace scree
