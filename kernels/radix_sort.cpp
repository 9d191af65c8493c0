#include "kernels/radix_sort.h"

#include <algorithm>
#include <array>

#include "kernels/parallel.h"

namespace scree {

namespace {

constexpr int kDigitBits = 8;  // 256 destinations: as many write streams as the caches and the TLB follow
constexpr size_t kDigits = size_t{1} << kDigitBits;
using Histogram = std::array<size_t, kDigits>;

size_t digit_of(uint64_t packed, int shift) { return (packed >> shift) & (kDigits - 1); }

// Turns counts per piece into first positions: by digit, then by piece, which keeps the sort stable.
void positions_from_counts(std::vector<Histogram>& pieces) {
  size_t position = 0;
  for (size_t digit = 0; digit < kDigits; ++digit)
    for (Histogram& piece : pieces) {
      const size_t count = piece[digit];
      piece[digit] = position;
      position += count;
    }
}

}  // namespace

void radix_sort(std::vector<uint64_t>& packed, std::vector<uint64_t>& scratch, int bits) {
  const size_t count = packed.size();
  const size_t pieces = std::max<size_t>(1, std::min<size_t>(4 * static_cast<size_t>(thread_count()), count / 4096));
  std::vector<Histogram> histograms(pieces);
  const auto begin_of = [&](size_t piece) { return count * piece / pieces; };
  scratch.resize(count);
  for (int shift = 32; shift < 32 + bits; shift += kDigitBits) {
    parallel_for(pieces, [&](size_t piece) {
      histograms[piece].fill(0);
      for (size_t k = begin_of(piece); k < begin_of(piece + 1); ++k) ++histograms[piece][digit_of(packed[k], shift)];
    });
    positions_from_counts(histograms);
    parallel_for(pieces, [&](size_t piece) {
      Histogram next = histograms[piece];
      for (size_t k = begin_of(piece); k < begin_of(piece + 1); ++k)
        scratch[next[digit_of(packed[k], shift)]++] = packed[k];
    });
    packed.swap(scratch);
  }
}

}  // namespace scree
