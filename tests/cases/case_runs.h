// Runs case files into temporary folders and reads back what they leave.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "runtime/case_reader.h"
#include "runtime/simulation.h"

namespace scree {

inline std::string case_path(const std::string& name) { return std::string(SCREE_SOURCE_DIR) + "/cases/" + name; }

class TemporaryFolder {
 public:
  TemporaryFolder() {
    static int number = 0;
    path_ = std::filesystem::temp_directory_path() /
            ("scree_test_" + std::to_string(getpid()) + "_" + std::to_string(number++));
    std::filesystem::create_directories(path_);
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

struct Table {
  std::vector<std::string> columns;
  std::vector<std::vector<double>> rows;

  std::vector<double> column(const std::string& name) const {
    const auto at = std::find(columns.begin(), columns.end(), name) - columns.begin();
    std::vector<double> values;
    for (const auto& row : rows) values.push_back(row.at(at));
    return values;
  }
};

inline Table read_table(const std::filesystem::path& path) {
  std::ifstream file(path);
  Table t;
  std::string line, cell;
  for (bool header = true; std::getline(file, line); header = false) {
    std::istringstream cells(line);
    if (!header) t.rows.emplace_back();
    while (std::getline(cells, cell, ',')) {
      if (header)
        t.columns.push_back(cell);
      else
        t.rows.back().push_back(std::stod(cell));
    }
  }
  return t;
}

// Value of a curve (x ascending) at `at`, linear in between.
inline double value_at(const std::vector<double>& x, const std::vector<double>& y, double at) {
  const size_t k = std::clamp<size_t>(std::lower_bound(x.begin(), x.end(), at) - x.begin(), 1, x.size() - 1);
  return y[k - 1] + (y[k] - y[k - 1]) * (at - x[k - 1]) / (x[k] - x[k - 1]);
}

inline nlohmann::json read_summary(const std::filesystem::path& out) {
  std::ifstream file(out / "summary.json");
  return nlohmann::json::parse(file);
}

inline RunResult run_to(const std::filesystem::path& out, const std::string& name,
                        const std::vector<std::string>& overrides = {}) {
  RunOptions options;
  options.out = out;
  return run_case(read_case(case_path(name), overrides), options);
}

}  // namespace scree
