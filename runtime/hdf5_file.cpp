#include "runtime/hdf5_file.h"

#include <algorithm>
#include <cstring>

#include "runtime/checksum.h"
#include "runtime/hdf5_handle.h"

namespace scree {

namespace {

constexpr uint64_t kBuffer = 8 << 20;       // B: smaller pieces are gathered, larger ones go straight to the file
constexpr uint64_t kLargeArray = 64 << 10;  // B: from here on an array's extent is told to the caller

// The newest layout: HDF5 checks its own structures by checksums then.
Handle access_properties() {
  Handle list = unlocked_access();
  checked(H5Pset_libver_bounds(list, H5F_LIBVER_LATEST, H5F_LIBVER_LATEST), "");
  return list;
}

// The array that is being written or read.
struct OpenArray {
  std::string name;
  ElementType type{};
  Handle type_id, space, set;
  uint64_t count = 0;  // elements
  uint64_t at = 0;     // next element to cross between the file and memory
  bool is_open = false;

  template <class Transfer>
  void transfer(uint64_t elements, const Transfer& through) {
    if (elements == 0) return;
    const hsize_t start = at, size = elements;
    const Handle memory(H5Screate_simple(1, &size, nullptr), H5Sclose);
    checked(H5Sselect_hyperslab(space, H5S_SELECT_SET, &start, nullptr, &size, nullptr), name);
    checked(through(memory), name);
    at += elements;
  }
};

}  // namespace

// ---- writing

struct Hdf5Writer::State {
  Handle file, link_properties, set_properties;
  OpenArray array;
  uint64_t promised = 0;  // elements that append() has brought
  std::vector<char> buffer;
  Checksum checksum;
  std::vector<Extent> extents;

  void write(const void* data, uint64_t elements) {
    checksum.add(data, elements * array.type.size);
    array.transfer(elements, [&](hid_t memory) {
      return H5Dwrite(array.set, array.type_id, memory, array.space, H5P_DEFAULT, data);
    });
  }
  void empty_buffer() {
    if (!buffer.empty()) write(buffer.data(), buffer.size() / array.type.size);
    buffer.clear();
  }
};

Hdf5Writer::Hdf5Writer(const std::filesystem::path& path) : state_(std::make_unique<State>()) {
  const Hdf5Lock lock;
  State& s = *state_;
  require_library_memory();
  const Handle creation = property_list(H5P_FILE_CREATE);
  checked(H5Pset_userblock(creation, kHeaderBytes), "");
  s.file = Handle(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation, access_properties()), H5Fclose);
  s.link_properties = property_list(H5P_LINK_CREATE);
  checked(H5Pset_create_intermediate_group(s.link_properties, 1), "");
  s.set_properties = property_list(H5P_DATASET_CREATE);
  checked(H5Pset_fill_time(s.set_properties, H5D_FILL_TIME_NEVER), "");
  checked(H5Pset_obj_track_times(s.set_properties, false), "");
}

Hdf5Writer::~Hdf5Writer() = default;

void Hdf5Writer::begin(const std::string& name, const ElementType& type, uint64_t count) {
  const Hdf5Lock lock;
  State& s = *state_;
  if (s.array.is_open) throw std::logic_error("Hdf5Writer: '" + s.array.name + "' was not ended");
  const hsize_t size = count;
  OpenArray a;
  a.name = name, a.type = type, a.count = count, a.is_open = true;
  a.type_id = type_handle(type);
  a.space = Handle(H5Screate_simple(1, &size, nullptr), H5Sclose);
  a.set = Handle(H5Dcreate2(s.file, name.c_str(), a.type_id, a.space, s.link_properties, s.set_properties, H5P_DEFAULT),
                 H5Dclose, name);
  s.array = std::move(a);
  s.promised = 0, s.checksum = {};
}

void Hdf5Writer::append(const void* data, uint64_t count) {
  const Hdf5Lock lock;
  State& s = *state_;
  const uint64_t bytes = count * s.array.type.size;
  s.promised += count;
  if (s.promised > s.array.count) throw std::logic_error("Hdf5Writer: '" + s.array.name + "' is longer than announced");
  if (s.buffer.size() + bytes > kBuffer) s.empty_buffer();
  if (bytes > kBuffer / 8) {
    s.empty_buffer();
    return s.write(data, count);
  }
  const char* first = static_cast<const char*>(data);
  s.buffer.insert(s.buffer.end(), first, first + bytes);
}

void Hdf5Writer::end() {
  const Hdf5Lock lock;
  State& s = *state_;
  s.empty_buffer();
  if (s.array.at != s.array.count) throw std::logic_error("Hdf5Writer: '" + s.array.name + "' is too short");
  const uint64_t bytes = s.array.count * s.array.type.size;
  if (bytes >= kLargeArray) {
    const haddr_t offset = H5Dget_offset(s.array.set);
    if (offset == HADDR_UNDEF) throw Hdf5Error(s.array.name + ": " + hdf5_reason());
    s.extents.push_back({offset, bytes, s.checksum.value()});
  }
  s.array = {};
}

std::vector<Extent> Hdf5Writer::close() {
  const Hdf5Lock lock;
  state_->file.close();
  return std::move(state_->extents);
}

// ---- reading

struct Hdf5Reader::State {
  Handle file;
  OpenArray array;
  std::vector<char> buffer;
  size_t used = 0;  // bytes of the buffer that were given out

  void read(void* data, uint64_t elements) {
    array.transfer(elements, [&](hid_t memory) {
      return H5Dread(array.set, array.type_id, memory, array.space, H5P_DEFAULT, data);
    });
  }
  uint64_t left() const { return array.count - array.at + (buffer.size() - used) / array.type.size; }
  void fill_buffer() {
    const uint64_t elements = std::min(kBuffer / array.type.size + 1, array.count - array.at);
    buffer.resize(elements * array.type.size), used = 0;
    read(buffer.data(), elements);
  }
};

Hdf5Reader::Hdf5Reader(const std::filesystem::path& path) : state_(std::make_unique<State>()) {
  const Hdf5Lock lock;
  require_library_memory();
  state_->file = Handle(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access_properties()), H5Fclose);
}

Hdf5Reader::~Hdf5Reader() = default;

bool Hdf5Reader::has(const std::string& name) {
  const Hdf5Lock lock;
  for (size_t end = name.find('/');; end = name.find('/', end + 1)) {  // the library asks for each group on the way
    if (H5Lexists(state_->file, name.substr(0, end).c_str(), H5P_DEFAULT) <= 0) return false;
    if (end == std::string::npos) return true;
  }
}

uint64_t Hdf5Reader::begin(const std::string& name, const ElementType& type) {
  const Hdf5Lock lock;
  State& s = *state_;
  OpenArray a;
  a.name = name, a.type = type, a.is_open = true;
  a.type_id = type_handle(type);
  a.set = Handle(H5Dopen2(s.file, name.c_str(), H5P_DEFAULT), H5Dclose, name);
  a.space = Handle(H5Dget_space(a.set), H5Sclose, name);
  const Handle stored(H5Dget_type(a.set), H5Tclose, name);
  if (H5Tequal(stored, a.type_id) <= 0) throw Hdf5Error(name + ": the elements are of another type");
  a.count = static_cast<uint64_t>(checked(H5Sget_simple_extent_npoints(a.space), name));
  if (a.count > H5Dget_storage_size(a.set) * most_expansion(a.set) / type.size)
    throw Hdf5Error(name + ": longer than what the file holds of it");
  s.array = std::move(a);
  s.buffer.clear(), s.used = 0;
  return s.array.count;
}

void Hdf5Reader::next(void* data, uint64_t count) {
  const Hdf5Lock lock;
  State& s = *state_;
  if (count > s.left()) throw Hdf5Error(s.array.name + ": too short");
  char* to = static_cast<char*>(data);
  uint64_t bytes = count * s.array.type.size;
  while (bytes > 0) {
    if (s.used == s.buffer.size()) {
      if (bytes > kBuffer / 8) return s.read(to, bytes / s.array.type.size);
      s.fill_buffer();
    }
    const uint64_t taken = std::min<uint64_t>(bytes, s.buffer.size() - s.used);
    std::memcpy(to, s.buffer.data() + s.used, taken);
    s.used += taken, to += taken, bytes -= taken;
  }
}

void Hdf5Reader::end() {
  const Hdf5Lock lock;
  if (state_->left() > 0) throw Hdf5Error(state_->array.name + ": too long");
  state_->array = {};
}

}  // namespace scree
