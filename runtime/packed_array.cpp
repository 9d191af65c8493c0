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

PackedArray without_pieces(const PlainArray& a) {
  return {a.name, a.type, a.size, a.piece_rows, std::vector<std::vector<unsigned char>>(a.pieces())};
}

void pack_piece(const PlainArray& a, uint64_t piece, PackedArray& to) {
  const uint64_t row_bytes = a.per_row() * a.type.size, first = piece * a.piece_rows;
  const auto* from = static_cast<const unsigned char*>(a.values) + first * row_bytes;
  std::vector<unsigned char> filled_up;
  if (const uint64_t rows = a.rows() - first; rows < a.piece_rows) {
    filled_up.assign(a.piece_rows * row_bytes, 0);
    std::memcpy(filled_up.data(), from, rows * row_bytes);
    from = filled_up.data();
  }
  to.pieces[piece] = shuffled_deflate(from, a.piece_rows * a.per_row(), a.type.size);
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

PackedArray packed(const PlainArray& array) {
  PackedArray result = without_pieces(array);
  for (uint64_t piece = 0; piece < array.pieces(); ++piece) pack_piece(array, piece, result);
  return result;
}

std::vector<PackedArray> packed(std::span<const PlainArray> arrays) {
  std::vector<PackedArray> result;
  struct Job {
    size_t array;
    uint64_t piece, bytes;
  };
  std::vector<Job> jobs;
  for (size_t k = 0; k < arrays.size(); ++k) {
    result.push_back(without_pieces(arrays[k]));
    for (uint64_t piece = 0; piece < arrays[k].pieces(); ++piece)
      jobs.push_back({k, piece, arrays[k].piece_rows * arrays[k].per_row() * arrays[k].type.size});
  }
  std::ranges::stable_sort(jobs, std::greater<>(), &Job::bytes);  // so that no thread is left with a large one
  parallel_for(jobs.size(), [&](size_t k) { pack_piece(arrays[jobs[k].array], jobs[k].piece, result[jobs[k].array]); });
  return result;
}

}  // namespace scree
