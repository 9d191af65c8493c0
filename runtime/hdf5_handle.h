// What the files that name HDF5 share: handles that close themselves, errors as exceptions, one thread at a time.
// Included by hdf5_file.cpp, vtkhdf_file.cpp and vtkhdf_reader.cpp only.
#pragma once

#include <hdf5.h>

#include <mutex>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "runtime/hdf5_file.h"

namespace scree {

// Held by whoever calls the library, which is not made for threads: a checkpoint and the writer of field files take
// turns, array by array. The first lock prepares the library.
class Hdf5Lock {
 public:
  Hdf5Lock();

 private:
  std::unique_lock<std::recursive_mutex> lock_;
};

// What the system said, if the innermost error of HDF5's stack quotes it; else that error.
std::string hdf5_reason();

template <class Id>
Id checked(Id id, const std::string& what) {
  if (id < 0) throw Hdf5Error(what.empty() ? hdf5_reason() : what + ": " + hdf5_reason());
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
    if (id_ < 0) return;
    const Hdf5Lock lock;
    close_(id_);
  }
  void close() { checked(close_(std::exchange(id_, -1)), ""); }
  operator hid_t() const { return id_; }

 private:
  hid_t id_ = -1;
  Close close_ = nullptr;
};

// Before a file is opened: the library writes through null pointers where memory ends on the way (seen: H5AC_create of
// 1.10). Throws std::bad_alloc where it has no room to work in.
void require_library_memory();

// Bytes of an array, at most, for each byte of the file that holds it; a claim beyond is corrupt, and no memory is
// asked for it.
uint64_t most_expansion(hid_t array);

Handle property_list(hid_t type);
Handle type_handle(const ElementType& type);

// No file locks of the library's: some network file systems refuse them, and the run's folder has its own
// (runtime/run_folder.h).
Handle unlocked_access();

}  // namespace scree
