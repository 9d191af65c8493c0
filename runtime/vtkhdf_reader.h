// Reads back a VTKHDF file (runtime/vtkhdf_file.h writes them; the layout is there).
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "runtime/hdf5_file.h"

namespace scree {

// Throws Hdf5Error if the file cannot be opened, or holds no such array of numbers.
class VtkHdfReader {
 public:
  explicit VtkHdfReader(const std::filesystem::path& path);
  ~VtkHdfReader();

  std::vector<std::string> point_data();  // names within PointData, in alphabetical order

  struct Rows {
    uint64_t count = 0;          // of rows
    int components = 1;          // of a row
    std::vector<double> values;  // row after row
  };
  Rows read(const std::string& name);  // `name` within /VTKHDF, "PointData/velocity"; any type of number

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace scree
