#include "runtime/vtkhdf_file.h"

#include <algorithm>
#include <cstring>
#include <functional>
#include <numeric>

#include "runtime/hdf5_handle.h"
#include "runtime/shuffled_deflate.h"

namespace scree {

namespace {

constexpr uint64_t kPieceRows = 65536;  // of an array, compressed together
constexpr int kLevel = 1;               // of gzip, as the file has it: readers do not ask
constexpr uint8_t kVertex = 1;          // VTK's number for it

}  // namespace

struct VtkHdfFile::State {
  Handle file, group, link_properties;
  ShuffledDeflate compressor;

  // An array with its space and, unless it is empty, its filters and pieces.
  Handle make(const std::string& name, const ElementType& type, int rank, const hsize_t* size, const hsize_t* piece) {
    const Handle properties = property_list(H5P_DATASET_CREATE);
    checked(H5Pset_obj_track_times(properties, false), "");
    if (size[0] > 0) {
      checked(H5Pset_chunk(properties, rank, piece), name);
      checked(H5Pset_shuffle(properties), name);
      checked(H5Pset_deflate(properties, kLevel), name);
    }
    const Handle space(H5Screate_simple(rank, size, nullptr), H5Sclose);
    return {H5Dcreate2(group, name.c_str(), type_handle(type), space, link_properties, properties, H5P_DEFAULT),
            H5Dclose, name};
  }

  void attribute(const std::string& name, hid_t file_type, hid_t memory_type, hsize_t count, const void* values) {
    const Handle space(count ? H5Screate_simple(1, &count, nullptr) : H5Screate(H5S_SCALAR), H5Sclose);
    const Handle id(H5Acreate2(group, name.c_str(), file_type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose, name);
    checked(H5Awrite(id, memory_type, values), name);
  }
};

VtkHdfFile::VtkHdfFile(const std::filesystem::path& path, VtkHdfType type) : state_(std::make_unique<State>()) {
  const Hdf5Lock lock;
  State& s = *state_;
  require_library_memory();
  s.file = Handle(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, unlocked_access()), H5Fclose);
  s.group = Handle(H5Gcreate2(s.file, "VTKHDF", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
  s.link_properties = property_list(H5P_LINK_CREATE);
  checked(H5Pset_create_intermediate_group(s.link_properties, 1), "");
  const int64_t version[] = {1, 0};
  attribute("Version", version);
  const std::string name = type == VtkHdfType::image_data ? "ImageData" : "UnstructuredGrid";
  const Handle text(H5Tcopy(H5T_C_S1), H5Tclose);  // ASCII of fixed length, without a zero at the end
  checked(H5Tset_size(text, name.size()), "");
  checked(H5Tset_strpad(text, H5T_STR_NULLPAD), "");
  s.attribute("Type", text, text, 0, name.data());
}

VtkHdfFile::~VtkHdfFile() = default;

void VtkHdfFile::attribute(const std::string& name, std::span<const int64_t> values) {
  const Hdf5Lock lock;
  state_->attribute(name, H5T_STD_I64LE, H5T_NATIVE_INT64, values.size(), values.data());
}

void VtkHdfFile::attribute(const std::string& name, std::span<const double> values) {
  const Hdf5Lock lock;
  state_->attribute(name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, values.size(), values.data());
}

void VtkHdfFile::array(const std::string& name, const ElementType& type, const void* values, uint64_t count,
                       uint64_t components) {
  const uint64_t per_row = std::max<uint64_t>(components, 1), rows = count / per_row;
  const uint64_t pieces = std::max<uint64_t>(1, (rows + kPieceRows - 1) / kPieceRows);
  const uint64_t size[] = {rows, per_row};
  blocks(name, type, values, std::span(size).first(components ? 2 : 1), (rows + pieces - 1) / pieces);
}

void VtkHdfFile::image(const std::string& name, std::span<const float> values, const std::array<int, 3>& points,
                       uint64_t components) {
  const uint64_t size[] = {uint64_t(points[2]), uint64_t(points[1]), uint64_t(points[0]), components};
  const uint64_t layers = std::max<uint64_t>(1, kPieceRows / (size[1] * size[2]));
  blocks(name, element_type<float>(), values.data(), std::span(size).first(components > 1 ? 4 : 3),
         std::min(layers, size[0]));
}

// The library is locked for its own calls, not while a piece is compressed.
void VtkHdfFile::blocks(const std::string& name, const ElementType& type, const void* values,
                        std::span<const uint64_t> size, uint64_t piece_rows) {
  const int rank = static_cast<int>(size.size());
  std::vector<hsize_t> whole(size.begin(), size.end()), piece = whole;
  piece[0] = piece_rows;
  const uint64_t rows = size[0];
  const uint64_t per_row = std::accumulate(size.begin() + 1, size.end(), uint64_t{1}, std::multiplies<>());
  Handle set;
  {
    const Hdf5Lock lock;
    set = state_->make(name, type, rank, whole.data(), piece.data());
  }
  const auto* data = static_cast<const unsigned char*>(values);
  std::vector<unsigned char> padded;
  std::vector<hsize_t> at(size.size(), 0);
  const uint64_t piece_elements = piece_rows * per_row;
  for (uint64_t row = 0; row < rows; row += piece_rows) {
    const unsigned char* from = data + row * per_row * type.size;
    if (rows - row < piece_rows) {  // the last piece is a whole one, too
      padded.assign(piece_elements * type.size, 0);
      std::memcpy(padded.data(), from, (rows - row) * per_row * type.size);
      from = padded.data();
    }
    const auto packed = state_->compressor.pack(from, piece_elements, type.size);
    const Hdf5Lock lock;
    at[0] = row;
    checked(H5Dwrite_chunk(set, H5P_DEFAULT, 0, at.data(), packed.size(), packed.data()), name);
  }
  const Hdf5Lock lock;
  set.close();
}

void VtkHdfFile::close() {
  const Hdf5Lock lock;
  state_->group.close();
  state_->file.close();
}

int64_t VtkGrid::add_point(double x, double y, double z) {
  for (const double c : {x, y, z}) points.push_back(static_cast<float>(c));
  return static_cast<int64_t>(points.size() / 3) - 1;
}

void VtkGrid::add_cell(uint8_t type, std::span<const int64_t> corners) {
  connectivity.insert(connectivity.end(), corners.begin(), corners.end());
  offsets.push_back(static_cast<int64_t>(connectivity.size()));
  types.push_back(type);
}

namespace {

void write_cells(VtkHdfFile& file, int64_t points, std::span<const int64_t> connectivity,
                 std::span<const int64_t> offsets, std::span<const uint8_t> types) {
  const auto number = [&](const char* name, int64_t value) { file.array(name, std::span<const int64_t>(&value, 1)); };
  number("NumberOfPoints", points);
  number("NumberOfCells", static_cast<int64_t>(types.size()));
  number("NumberOfConnectivityIds", static_cast<int64_t>(connectivity.size()));
  file.array("Connectivity", connectivity);
  file.array("Offsets", offsets);
  file.array("Types", types);
}

}  // namespace

void write_grid(VtkHdfFile& file, const VtkGrid& grid) {
  file.array("Points", std::span<const float>(grid.points), 3);
  write_cells(file, static_cast<int64_t>(grid.points.size() / 3), grid.connectivity, grid.offsets, grid.types);
}

void write_vertices(VtkHdfFile& file, const ElementType& coordinate, const void* points, uint64_t count) {
  std::vector<int64_t> numbers(count + 1);
  std::iota(numbers.begin(), numbers.end(), 0);
  file.array("Points", coordinate, points, 3 * count, 3);
  write_cells(file, static_cast<int64_t>(count), std::span(numbers).first(count), numbers,
              std::vector<uint8_t>(count, kVertex));
}

}  // namespace scree
