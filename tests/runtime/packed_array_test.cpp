#include "runtime/packed_array.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cstring>
#include <numeric>
#include <vector>

#include "kernels/parallel.h"

namespace scree {
namespace {

// Undoes gzip and shuffle of every piece; what a last piece was filled up with is left out.
template <class T>
std::vector<T> unpacked(const PackedArray& a, size_t count) {
  std::vector<T> values;
  for (const auto& piece : a.pieces) {
    const size_t n = a.piece_rows * (a.size.size() > 1 ? a.size[1] : 1);
    std::vector<unsigned char> bytes(n * sizeof(T)), value(sizeof(T));
    uLongf got = bytes.size();
    EXPECT_EQ(uncompress(bytes.data(), &got, piece.data(), piece.size()), Z_OK);
    EXPECT_EQ(got, bytes.size());
    for (size_t k = 0; k < n && values.size() < count; ++k) {
      for (size_t b = 0; b < sizeof(T); ++b) value[b] = bytes[b * n + k];
      std::memcpy(&values.emplace_back(), value.data(), sizeof(T));
    }
  }
  return values;
}

TEST(PackedArrays, HoldTheirNumbersInPiecesOfEqualLengthWhateverTheThreads) {
  const size_t rows = 40001;  // three pieces, the last one shorter
  std::vector<float> vectors(3 * rows);
  std::iota(vectors.begin(), vectors.end(), 0.0F);
  std::vector<int64_t> list(rows);
  std::iota(list.begin(), list.end(), -7);
  const std::vector<uint8_t> none;
  const std::vector<PlainArray> plain{plain_array("vectors", std::span<const float>(vectors), 3),
                                      plain_array("list", std::span<const int64_t>(list)),
                                      plain_array("none", std::span<const uint8_t>(none))};
  const int before = thread_count();
  for (const int threads : {1, 3}) {
    set_thread_count(threads);
    int beside = 0;
    const std::vector<PackedArray> all = packed(plain, [&] { ++beside; });
    EXPECT_EQ(beside, 1);
    ASSERT_EQ(all.size(), plain.size());
    EXPECT_EQ(all[0].size, (std::vector<uint64_t>{rows, 3}));
    EXPECT_EQ(all[0].pieces.size(), 3u);
    EXPECT_EQ(unpacked<float>(all[0], vectors.size()), vectors);
    EXPECT_EQ(unpacked<int64_t>(all[1], list.size()), list);
    EXPECT_TRUE(all[2].pieces.empty());
    for (size_t k = 0; k < all.size(); ++k) EXPECT_EQ(all[k].pieces, packed(plain[k]).pieces) << plain[k].name;
  }
  set_thread_count(before);
}

}  // namespace
}  // namespace scree
