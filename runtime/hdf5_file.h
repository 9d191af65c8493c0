// Named arrays in an HDF5 file, written and read front to back in pieces. Several threads may use files of their own at
// once (runtime/hdf5_handle.h). Data lie contiguous and uncompressed; the first kHeaderBytes of the file are left to
// others (runtime/seal.h).
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace scree {

// The reason alone ("No space left on device"), without the file's name.
struct Hdf5Error : std::runtime_error {
  using std::runtime_error::runtime_error;
};

inline constexpr uint64_t kHeaderBytes = 4096;

// Numbers are numbers to every HDF5 reader; records of several fields are opaque bytes of a known size.
struct ElementType {
  enum class Kind { whole, natural, real, record } kind;
  size_t size;
};

template <class T>
constexpr ElementType element_type() {
  static_assert(std::is_trivially_copyable_v<T>);
  using Kind = ElementType::Kind;
  if constexpr (std::is_floating_point_v<T>) return {Kind::real, sizeof(T)};
  if constexpr (std::is_integral_v<T> && std::is_signed_v<T>) return {Kind::whole, sizeof(T)};
  if constexpr (std::is_integral_v<T>) return {Kind::natural, sizeof(T)};
  return {Kind::record, sizeof(T)};
}

// Where an array's bytes lie in the file.
struct Extent {
  uint64_t offset = 0, size = 0, checksum = 0;
};

class Hdf5Writer {
 public:
  explicit Hdf5Writer(const std::filesystem::path& path);  // a new file
  ~Hdf5Writer();

  // begin() names an array (groups by "/") and says how many elements will come; append() brings them; end().
  void begin(const std::string& name, const ElementType& type, uint64_t count);
  void append(const void* data, uint64_t count);
  void end();

  // Closes the file; returns the extents of the large arrays, in no order. Small ones are not worth listing.
  std::vector<Extent> close();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// Where named arrays come from. Throws Hdf5Error if there is none of that name and type, or too few elements.
class ArraySource {
 public:
  virtual ~ArraySource() = default;
  virtual bool has(const std::string& name) = 0;  // a group or an array
  // begin() returns how many elements there are; next() gives the next `count` of them; end() checks that none is left.
  virtual uint64_t begin(const std::string& name, const ElementType& type) = 0;
  virtual void next(void* data, uint64_t count) = 0;
  virtual void end() = 0;
};

class Hdf5Reader final : public ArraySource {
 public:
  explicit Hdf5Reader(const std::filesystem::path& path);
  ~Hdf5Reader() override;

  bool has(const std::string& name) override;
  uint64_t begin(const std::string& name, const ElementType& type) override;
  void next(void* data, uint64_t count) override;
  void end() override;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace scree
