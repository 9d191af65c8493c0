// What HDF5's shuffle and gzip filters make of numbers, made faster.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace scree {

// Shuffled, the lowest bytes of all numbers come first, the highest (sign and exponent) last: planes. The low ones of a
// grain's position or velocity are noise, the high ones are nearly the same for all. Each plane is deflated by itself,
// by ISA-L, which stores one that does not shrink; together they are one zlib stream, which every reader takes. The
// same numbers give the same bytes.
// Layout: RFC 1950, RFC 1951.
class ShuffledDeflate {
 public:
  // `data`: `elements` numbers of `size` bytes (1, 2, 4 or 8). The stream is good until the next call.
  std::span<const unsigned char> pack(const unsigned char* data, uint64_t elements, size_t size);

 private:
  void deflate(std::span<const unsigned char> plane, bool last);

  std::vector<unsigned char> shuffled_, packed_;
};

}  // namespace scree
