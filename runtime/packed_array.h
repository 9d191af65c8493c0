// Arrays as field files hold them: cut into pieces of whole rows, each shuffled and deflated by itself.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "runtime/hdf5_file.h"

namespace scree {

// Numbers that somebody else holds, one after the other.
struct PlainArray {
  std::string name;
  ElementType type{};
  const void* values = nullptr;
  std::vector<uint64_t> size;  // slowest first: {rows} or {rows, components} or {layers, ..., components}
  uint64_t piece_rows = 0;     // of the first of them; the last piece is filled up with zeros

  uint64_t rows() const { return size[0]; }
  uint64_t per_row() const;  // elements
  uint64_t pieces() const { return (rows() + piece_rows - 1) / piece_rows; }
};

// `components` 0: a list; else rows of so many values.
PlainArray plain_array(const std::string& name, const ElementType& type, const void* values, uint64_t count,
                       uint64_t components);
template <class T>
PlainArray plain_array(const std::string& name, std::span<const T> values, uint64_t components = 0) {
  return plain_array(name, element_type<T>(), values.data(), values.size(), components);
}

struct PackedArray {
  std::string name;
  ElementType type{};
  std::vector<uint64_t> size;
  uint64_t piece_rows = 0;
  std::vector<std::vector<unsigned char>> pieces;  // zlib streams (runtime/shuffled_deflate.h)
};

PackedArray packed(const PlainArray& array);  // on this thread
// The same bytes, on all threads. `beside`: something else to do, which one of them begins with.
std::vector<PackedArray> packed(std::span<const PlainArray> arrays, const std::function<void()>& beside = {});

// For arrays of which some pieces are there at a time: one with the array's form, whose pieces are yet to come, and
// those from `first_piece` on of each of `to`, made of the rows that `parts` holds, on all threads.
PackedArray without_pieces(const PlainArray& array);
void pack_pieces(std::span<const PlainArray> parts, uint64_t first_piece, std::span<PackedArray* const> to,
                 const std::function<void()>& beside = {});

}  // namespace scree
