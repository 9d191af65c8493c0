// Field files as VTK's own reader sees them, when it is installed (Debian: python3-vtk9).
#pragma once

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace scree {

// The Python that has it: the one on the path, or Debian's own. Empty: none.
inline const std::string& vtk_python() {
  static const std::string python = [] {
    for (const std::string name : {"python3", "/usr/bin/python3"})
      if (std::system((name + " -c 'import vtkmodules.vtkIOHDF' 2>/dev/null").c_str()) == 0) return name;
    return std::string();
  }();
  return python;
}
inline bool has_vtk_reader() { return !vtk_python().empty(); }
inline const char* const kNoVtkReader =
    "not tried: VTK's Python reader is not installed (apt-get install python3-vtk9)";

struct VtkArray {
  uint64_t components = 0;
  std::string type;
  std::vector<double> values;  // what is not finite: not a number
};

struct VtkData {
  std::string class_name;
  VtkArray points;
  std::vector<std::vector<int64_t>> cells;  // VTK's number of the cell's type, then its points
  nlohmann::json json;                      // point_data, cell_data, field_data by name

  VtkArray array(const std::string& where, const std::string& name) const { return from(json.at(where).at(name)); }
  static VtkArray from(const nlohmann::json& j) {
    VtkArray a{j.at("components"), j.at("type"), {}};
    for (const auto& v : j.at("values")) a.values.push_back(v.is_null() ? std::nan("") : v.get<double>());
    return a;
  }
};

// Fails the test with what VTK says if it cannot read one.
inline std::vector<VtkData> read_with_vtk(const std::vector<std::filesystem::path>& files) {
  std::string command = vtk_python() + " " + SCREE_SOURCE_DIR + "/tests/runtime/vtk_dump.py";
  for (const auto& file : files) command += " '" + file.string() + "'";
  std::FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  std::string text;
  char piece[4096];
  for (size_t n; (n = std::fread(piece, 1, sizeof piece, pipe)) > 0;) text.append(piece, n);
  const int status = pclose(pipe);
  std::vector<VtkData> result;
  if (status != 0) {
    ADD_FAILURE() << text;
    return std::vector<VtkData>(files.size());
  }
  for (const nlohmann::json& j : nlohmann::json::parse(text)) {
    VtkData& d = result.emplace_back();
    d.class_name = j.at("class"), d.json = j;
    if (!j.at("points").is_null()) d.points = VtkData::from(j.at("points"));
    d.cells = j.at("cells").get<std::vector<std::vector<int64_t>>>();
  }
  return result;
}

}  // namespace scree
