// What HDF5's shuffle and gzip filters make of numbers, made faster.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

struct libdeflate_compressor;

namespace scree {

// Shuffled, the lowest bytes of all numbers come first, the highest (sign and exponent) last. The low ones of a grain's
// position or velocity are noise, on which deflate spends most of its time and gains nothing. They go in as stored
// blocks, the rest is deflated by libdeflate: one zlib stream, which every reader takes. Layout: RFC 1950, RFC 1951.
class ShuffledDeflate {
 public:
  ShuffledDeflate();  // throws std::bad_alloc

  // `data`: `elements` numbers of `size` bytes (1, 2, 4 or 8). The stream is good until the next call.
  std::span<const unsigned char> pack(const unsigned char* data, uint64_t elements, size_t size);

 private:
  struct Free {
    void operator()(libdeflate_compressor* c) const;
  };
  bool is_noise(const unsigned char* plane, uint64_t bytes);
  void store(std::span<const unsigned char> bytes);
  void deflate(std::span<const unsigned char> bytes);

  std::unique_ptr<libdeflate_compressor, Free> compressor_;
  std::vector<unsigned char> shuffled_, sample_, packed_;
};

}  // namespace scree
