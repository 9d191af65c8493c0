#include "runtime/packed_array.h"

#include <algorithm>
#include <cstring>
#include <functional>
#include <numeric>

#include "kernels/parallel.h"
#include "runtime/shuffled_deflate.h"

namespace scree {

namespace {

constexpr uint64_t kPieceRows = 16384;  // at most: what a thread packs stays in its cache

std::vector<unsigned char> packed_piece(const PlainArray& a, uint64_t piece) {
  const uint64_t row_bytes = a.per_row() * a.type.size, first = piece * a.piece_rows;
  const auto* from = static_cast<const unsigned char*>(a.values) + first * row_bytes;
  std::vector<unsigned char> filled_up;
  if (const uint64_t rows = a.rows() - first; rows < a.piece_rows) {
    filled_up.assign(a.piece_rows * row_bytes, 0);
    std::memcpy(filled_up.data(), from, rows * row_bytes);
    from = filled_up.data();
  }
  return shuffled_deflate(from, a.piece_rows * a.per_row(), a.type.size);
}

}  // namespace

uint64_t PlainArray::per_row() const {
  return std::accumulate(size.begin() + 1, size.end(), uint64_t{1}, std::multiplies<>());
}

PlainArray plain_array(const std::string& name, const ElementType& type, const void* values, uint64_t count,
                       uint64_t components) {
  const uint64_t per_row = std::max<uint64_t>(components, 1), rows = count / per_row;
  const uint64_t pieces = std::max<uint64_t>(1, (rows + kPieceRows - 1) / kPieceRows);
  PlainArray a{name, type, values, {rows}, std::max<uint64_t>(1, (rows + pieces - 1) / pieces)};
  if (components > 0) a.size.push_back(components);
  return a;
}

PackedArray without_pieces(const PlainArray& a) {
  return {a.name, a.type, a.size, a.piece_rows, std::vector<std::vector<unsigned char>>(a.pieces())};
}

PackedArray packed(const PlainArray& array) {
  PackedArray result = without_pieces(array);
  for (uint64_t piece = 0; piece < array.pieces(); ++piece) result.pieces[piece] = packed_piece(array, piece);
  return result;
}

void pack_pieces(std::span<const PlainArray> parts, uint64_t first_piece, std::span<PackedArray* const> to,
                 const std::function<void()>& beside) {
  struct Job {
    size_t array;
    uint64_t piece, bytes;
  };
  std::vector<Job> jobs;
  for (size_t k = 0; k < parts.size(); ++k)
    for (uint64_t piece = 0; piece < parts[k].pieces(); ++piece)
      jobs.push_back({k, piece, parts[k].piece_rows * parts[k].per_row() * parts[k].type.size});
  std::ranges::stable_sort(jobs, std::greater<>(), &Job::bytes);  // so that no thread is left with a large one
  const size_t others = beside ? 1 : 0;
  parallel_for(others + jobs.size(), [&](size_t k) {
    if (k < others) return beside();
    const auto [array, piece, bytes] = jobs[k - others];
    to[array]->pieces[first_piece + piece] = packed_piece(parts[array], piece);
  });
}

std::vector<PackedArray> packed(std::span<const PlainArray> arrays, const std::function<void()>& beside) {
  std::vector<PackedArray> result;
  for (const PlainArray& array : arrays) result.push_back(without_pieces(array));
  std::vector<PackedArray*> to;
  for (PackedArray& array : result) to.push_back(&array);
  pack_pieces(arrays, 0, to, beside);
  return result;
}

}  // namespace scree
