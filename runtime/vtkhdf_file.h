// A VTKHDF file: HDF5 laid out so that ParaView (5.11 and later) and VTK (9.1 and later) open it without plug-ins.
//
//   /VTKHDF            attributes Version = [1, 0], Type = "UnstructuredGrid" or "ImageData"
//     Points, ...      what the type asks for
//     PointData/NAME   one value per point; N x 3 is a vector, N x 6 a tensor xx yy zz xy yz xz
//     CellData/NAME, FieldData/NAME
//
// Version 1.0 has these two types only. Arrays are in pieces (runtime/packed_array.h), shuffled and gzipped: any HDF5
// reader undoes that. Layout: https://docs.vtk.org/en/latest/vtk_file_formats/vtkhdf_file_format
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "runtime/packed_array.h"

namespace scree {

enum class VtkHdfType { unstructured_grid, image_data };

// Written front to back, then closed; a file that was not closed is incomplete. Throws Hdf5Error.
class VtkHdfFile {
 public:
  VtkHdfFile(const std::filesystem::path& path, VtkHdfType type);
  ~VtkHdfFile();

  void attribute(const std::string& name, std::span<const int64_t> values);
  void attribute(const std::string& name, std::span<const double> values);

  // Names are within /VTKHDF: "PointData/velocity".
  void array(const PackedArray& array);
  template <class T>
  void array(const std::string& name, std::span<const T> values, uint64_t components = 0) {
    array(packed(plain_array(name, values, components)));
  }

  // Point data of an image: a value (components 1) or a row of values for each point, x fastest.
  void image(const std::string& name, std::span<const float> values, const std::array<int, 3>& points,
             uint64_t components);

  void close();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// Points and cells of an unstructured grid, as VTK has them.
struct VtkGrid {
  std::vector<float> points;          // x, y, z of each, m
  std::vector<int64_t> connectivity;  // points of the cells, one cell after the other
  std::vector<int64_t> offsets{0};    // where each cell begins; the last entry is connectivity's size
  std::vector<uint8_t> types;         // of each cell: 5 triangle, 9 quadrilateral

  int64_t add_point(double x, double y, double z);  // its index
  void add_cell(uint8_t type, std::span<const int64_t> corners);
};
void write_grid(VtkHdfFile& file, const VtkGrid& grid);

// The cells of `points` points that are cells of their own.
class VertexCells {
 public:
  explicit VertexCells(uint64_t points);
  std::vector<PlainArray> arrays() const;  // of what this holds

 private:
  std::vector<int64_t> numbers_;
  std::vector<uint8_t> types_;
  int64_t counts_[3];
};

}  // namespace scree
