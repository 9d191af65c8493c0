#include "runtime/vtkhdf_file.h"

#include <algorithm>
#include <numeric>

#include "runtime/hdf5_handle.h"

namespace scree {

namespace {

constexpr uint64_t kPieceElements = 65536;  // of an image, packed together
constexpr int kLevel = 1;                   // of gzip, as the file has it: readers do not ask
constexpr uint8_t kVertex = 1;              // VTK's number for it

}  // namespace

struct VtkHdfFile::State {
  Handle file, group, link_properties;

  // An array with its space and, unless it is empty, its filters and pieces.
  Handle make(const PackedArray& a) {
    const std::vector<hsize_t> size(a.size.begin(), a.size.end());
    const int rank = static_cast<int>(size.size());
    const Handle properties = property_list(H5P_DATASET_CREATE);
    checked(H5Pset_obj_track_times(properties, false), "");
    if (size[0] > 0) {
      std::vector<hsize_t> piece = size;
      piece[0] = a.piece_rows;
      checked(H5Pset_chunk(properties, rank, piece.data()), a.name);
      checked(H5Pset_shuffle(properties), a.name);
      checked(H5Pset_deflate(properties, kLevel), a.name);
    }
    const Handle space(H5Screate_simple(rank, size.data(), nullptr), H5Sclose);
    return {H5Dcreate2(group, a.name.c_str(), type_handle(a.type), space, link_properties, properties, H5P_DEFAULT),
            H5Dclose, a.name};
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

void VtkHdfFile::array(const PackedArray& a) {
  const Hdf5Lock lock;
  Handle set = state_->make(a);
  std::vector<hsize_t> at(a.size.size(), 0);
  for (const std::vector<unsigned char>& piece : a.pieces) {
    checked(H5Dwrite_chunk(set, H5P_DEFAULT, 0, at.data(), piece.size(), piece.data()), a.name);
    at[0] += a.piece_rows;
  }
  set.close();
}

void VtkHdfFile::image(const std::string& name, std::span<const float> values, const std::array<int, 3>& points,
                       uint64_t components) {
  const uint64_t nx = points[0], ny = points[1], nz = points[2];
  PlainArray a{name, element_type<float>(), values.data(), {nz, ny, nx}, 0};
  if (components > 1) a.size.push_back(components);
  a.piece_rows = std::clamp<uint64_t>(kPieceElements / (ny * nx), 1, nz);
  array(packed(a));
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

// `counts`: of points, cells and connectivity's entries.
std::vector<PlainArray> cell_arrays(std::span<const int64_t, 3> counts, std::span<const int64_t> connectivity,
                                    std::span<const int64_t> offsets, std::span<const uint8_t> types) {
  return {plain_array("NumberOfPoints", counts.subspan(0, 1)),
          plain_array("NumberOfCells", counts.subspan(1, 1)),
          plain_array("NumberOfConnectivityIds", counts.subspan(2, 1)),
          plain_array("Connectivity", connectivity),
          plain_array("Offsets", offsets),
          plain_array("Types", types)};
}

}  // namespace

void write_grid(VtkHdfFile& file, const VtkGrid& grid) {
  const int64_t counts[] = {static_cast<int64_t>(grid.points.size() / 3), static_cast<int64_t>(grid.types.size()),
                            static_cast<int64_t>(grid.connectivity.size())};
  file.array("Points", std::span<const float>(grid.points), 3);
  for (const PlainArray& a : cell_arrays(counts, grid.connectivity, grid.offsets, grid.types)) file.array(packed(a));
}

VertexCells::VertexCells(uint64_t points) : numbers_(points + 1), types_(points, kVertex) {
  std::iota(numbers_.begin(), numbers_.end(), 0);
  std::ranges::fill(counts_, static_cast<int64_t>(points));
}

std::vector<PlainArray> VertexCells::arrays() const {
  return cell_arrays(counts_, std::span(numbers_).first(types_.size()), numbers_, types_);
}

}  // namespace scree
