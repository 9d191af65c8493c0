#include "runtime/hdf5_file.h"

#include <hdf5.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include "runtime/checksum.h"

namespace scree {

namespace {

constexpr uint64_t kBuffer = 8 << 20;       // B: smaller pieces are gathered, larger ones go straight to the file
constexpr uint64_t kLargeArray = 64 << 10;  // B: from here on an array's extent is told to the caller

// HDF5 must not clean up at exit: a file that a full disk kept from closing would be tried again, and can hang there.
void prepare_library() {
  static const bool prepared = [] {
    H5dont_atexit();
    H5open();
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // errors are thrown, not printed
    return true;
  }();
  static_cast<void>(prepared);
}

// What the system said, if the innermost error of HDF5's stack quotes it; else that error.
std::string reason() {
  std::string text = "unknown error of the HDF5 library";
  H5Ewalk2(
      H5E_DEFAULT, H5E_WALK_UPWARD,
      [](unsigned n, const H5E_error2_t* error, void* result) -> herr_t {
        if (n == 0 && error->desc) *static_cast<std::string*>(result) = error->desc;
        return 0;
      },
      &text);
  const std::string quote = "error message = '";
  const size_t begin = text.find(quote);
  if (begin == std::string::npos) return text;
  const size_t from = begin + quote.size();
  return text.substr(from, text.find('\'', from) - from);
}

template <class Id>
Id checked(Id id, const std::string& what) {
  if (id < 0) throw Hdf5Error(what.empty() ? reason() : what + ": " + reason());
  return id;
}

class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Handle() = default;
  Handle(hid_t id, Close close, const std::string& what = "") : id_(checked(id, what)), close_(close) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_), std::swap(close_, other.close_);
    return *this;
  }
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  void close() { checked(close_(std::exchange(id_, -1)), ""); }
  operator hid_t() const { return id_; }

 private:
  hid_t id_ = -1;
  Close close_ = nullptr;
};

Handle property_list(hid_t type) { return {H5Pcreate(type), H5Pclose}; }

// The newest layout: HDF5 checks its own structures by checksums then. No file locks of the library's: some network
// file systems refuse them, and the run's folder has its own (runtime/run_folder.h).
Handle access_properties() {
  Handle list = property_list(H5P_FILE_ACCESS);
  checked(H5Pset_libver_bounds(list, H5F_LIBVER_LATEST, H5F_LIBVER_LATEST), "");
  checked(H5Pset_file_locking(list, false, true), "");
  return list;
}

Handle type_handle(const ElementType& type) {
  using Kind = ElementType::Kind;
  const auto pick = [&](hid_t one, hid_t two, hid_t four, hid_t eight) {
    return type.size == 1 ? one : type.size == 2 ? two : type.size == 4 ? four : eight;
  };
  if (type.kind == Kind::record) {
    Handle opaque(H5Tcreate(H5T_OPAQUE, type.size), H5Tclose);
    checked(H5Tset_tag(opaque, fmt::format("record of {} bytes", type.size).c_str()), "");
    return opaque;
  }
  const hid_t native = type.kind == Kind::real ? pick(-1, -1, H5T_NATIVE_FLOAT, H5T_NATIVE_DOUBLE)
                       : type.kind == Kind::whole
                           ? pick(H5T_NATIVE_INT8, H5T_NATIVE_INT16, H5T_NATIVE_INT32, H5T_NATIVE_INT64)
                           : pick(H5T_NATIVE_UINT8, H5T_NATIVE_UINT16, H5T_NATIVE_UINT32, H5T_NATIVE_UINT64);
  return {H5Tcopy(native), H5Tclose};
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
  prepare_library();
  State& s = *state_;
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
  State& s = *state_;
  s.empty_buffer();
  if (s.array.at != s.array.count) throw std::logic_error("Hdf5Writer: '" + s.array.name + "' is too short");
  const uint64_t bytes = s.array.count * s.array.type.size;
  if (bytes >= kLargeArray) {
    const haddr_t offset = H5Dget_offset(s.array.set);
    if (offset == HADDR_UNDEF) throw Hdf5Error(s.array.name + ": " + reason());
    s.extents.push_back({offset, bytes, s.checksum.value()});
  }
  s.array = {};
}

std::vector<Extent> Hdf5Writer::close() {
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
  prepare_library();
  state_->file = Handle(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access_properties()), H5Fclose);
}

Hdf5Reader::~Hdf5Reader() = default;

uint64_t Hdf5Reader::begin(const std::string& name, const ElementType& type) {
  State& s = *state_;
  OpenArray a;
  a.name = name, a.type = type, a.is_open = true;
  a.type_id = type_handle(type);
  a.set = Handle(H5Dopen2(s.file, name.c_str(), H5P_DEFAULT), H5Dclose, name);
  a.space = Handle(H5Dget_space(a.set), H5Sclose, name);
  const Handle stored(H5Dget_type(a.set), H5Tclose, name);
  if (H5Tequal(stored, a.type_id) <= 0) throw Hdf5Error(name + ": the elements are of another type");
  a.count = static_cast<uint64_t>(checked(H5Sget_simple_extent_npoints(a.space), name));
  if (a.count > H5Dget_storage_size(a.set) / type.size)
    throw Hdf5Error(name + ": longer than what the file holds of it");
  s.array = std::move(a);
  s.buffer.clear(), s.used = 0;
  return s.array.count;
}

void Hdf5Reader::next(void* data, uint64_t count) {
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
  if (state_->left() > 0) throw Hdf5Error(state_->array.name + ": too long");
  state_->array = {};
}

}  // namespace scree
