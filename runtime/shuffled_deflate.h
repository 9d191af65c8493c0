// What HDF5's shuffle and gzip filters make of numbers, made faster.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace scree {

// Shuffled, the lowest bytes of all numbers come first, the highest (sign and exponent) last: planes. The low ones of a
// grain's position or velocity are noise, the high ones are nearly the same for all. Each plane is deflated by itself,
// by ISA-L, or stored if it does not shrink; together they are one zlib stream, which every reader takes. The same
// numbers give the same bytes.
// `data`: `elements` numbers of `size` bytes (1, 2, 4 or 8).
// Layout: RFC 1950, RFC 1951.
std::vector<unsigned char> shuffled_deflate(const unsigned char* data, uint64_t elements, size_t size);

}  // namespace scree
