#include "runtime/hdf5_handle.h"

#include <cstdlib>
#include <new>

namespace scree {

namespace {

std::recursive_mutex& library_mutex() {
  static std::recursive_mutex mutex;
  return mutex;
}

// HDF5 must not clean up at exit: a file that a full disk kept from closing would be tried again, and can hang there.
// Where the library was built for threads, each has its own way of reporting errors: ours throw and do not print.
void prepare_library() {
  static const bool opened = [] { return H5dont_atexit(), H5open() >= 0; }();
  static_cast<void>(opened);
  thread_local const bool silent = H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr) >= 0;
  static_cast<void>(silent);
}

}  // namespace

Hdf5Lock::Hdf5Lock() : lock_(library_mutex()) { prepare_library(); }

std::string hdf5_reason() {
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

void require_library_memory() {
  constexpr size_t kWorkingMemory = 16 << 20;
  void* volatile memory = std::malloc(kWorkingMemory);  // volatile: or the compiler leaves both calls out
  if (!memory) throw std::bad_alloc();
  std::free(memory);
}

uint64_t most_expansion(hid_t array) {
  constexpr uint64_t kDeflateExpands = 1032;  // 258 bytes from two bits (RFC 1951)
  const Handle how(H5Dget_create_plist(array), H5Pclose);
  return checked(H5Pget_nfilters(how), "") > 0 ? kDeflateExpands : 1;
}

Handle property_list(hid_t type) { return {H5Pcreate(type), H5Pclose}; }

Handle unlocked_access() {
  Handle list = property_list(H5P_FILE_ACCESS);
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

}  // namespace scree
