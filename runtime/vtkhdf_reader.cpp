#include "runtime/vtkhdf_reader.h"

#include <array>

#include "runtime/hdf5_handle.h"

namespace scree {

struct VtkHdfReader::State {
  Handle file;
};

VtkHdfReader::VtkHdfReader(const std::filesystem::path& path) : state_(std::make_unique<State>()) {
  const Hdf5Lock lock;
  require_library_memory();
  state_->file = Handle(H5Fopen(path.c_str(), H5F_ACC_RDONLY, unlocked_access()), H5Fclose);
}

VtkHdfReader::~VtkHdfReader() = default;

std::vector<std::string> VtkHdfReader::point_data() {
  const Hdf5Lock lock;
  const std::string path = "/VTKHDF/PointData";
  const Handle group(H5Gopen2(state_->file, path.c_str(), H5P_DEFAULT), H5Gclose, path);
  H5G_info_t info;
  checked(H5Gget_info(group, &info), path);
  std::vector<std::string> names;
  for (hsize_t k = 0; k < info.nlinks; ++k) {
    std::array<char, 256> name{};
    checked(H5Lget_name_by_idx(group, ".", H5_INDEX_NAME, H5_ITER_INC, k, name.data(), name.size() - 1, H5P_DEFAULT),
            path);
    names.emplace_back(name.data());
  }
  return names;
}

VtkHdfReader::Rows VtkHdfReader::read(const std::string& name) {
  const Hdf5Lock lock;
  const Handle set(H5Dopen2(state_->file, ("/VTKHDF/" + name).c_str(), H5P_DEFAULT), H5Dclose, name);
  const Handle space(H5Dget_space(set), H5Sclose, name), type(H5Dget_type(set), H5Tclose, name);
  const H5T_class_t kind = H5Tget_class(type);
  if (kind != H5T_FLOAT && kind != H5T_INTEGER) throw Hdf5Error(name + ": not an array of numbers");
  std::array<hsize_t, 2> size{0, 1};
  const int rank = H5Sget_simple_extent_ndims(space);
  if (rank < 1 || rank > 2) throw Hdf5Error(name + ": neither a list nor rows of values");
  checked(H5Sget_simple_extent_dims(space, size.data(), nullptr), name);
  if (size[0] * size[1] > H5Dget_storage_size(set) * most_expansion(set) / H5Tget_size(type))
    throw Hdf5Error(name + ": longer than what the file holds of it");
  Rows rows{size[0], static_cast<int>(size[1]), std::vector<double>(size[0] * size[1])};
  checked(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, rows.values.data()), name);
  return rows;
}

}  // namespace scree
