#include "runtime/shuffled_deflate.h"

#include <isa-l/igzip_lib.h>

#include <limits>
#include <stdexcept>

namespace scree {

namespace {

// First bytes of all elements, then second bytes, ...
template <size_t size>
void shuffle(const unsigned char* data, uint64_t elements, unsigned char* to) {
  for (uint64_t k = 0; k < elements; ++k)
    for (size_t b = 0; b < size; ++b) to[b * elements + k] = data[k * size + b];
}

void shuffle(const unsigned char* data, uint64_t elements, size_t size, unsigned char* to) {
  switch (size) {
    case 1:
      return shuffle<1>(data, elements, to);
    case 2:
      return shuffle<2>(data, elements, to);
    case 4:
      return shuffle<4>(data, elements, to);
    default:
      return shuffle<8>(data, elements, to);
  }
}

}  // namespace

// To the end of what is packed. Independent of the planes before, and it ends at a whole byte.
void ShuffledDeflate::deflate(std::span<const unsigned char> plane, bool last) {
  constexpr size_t kStoredBlock = 65535, kBlockHeader = 5;  // bytes
  constexpr size_t kFlush = 64;                             // bytes, more than what ends a plane
  if (plane.size() > std::numeric_limits<uint32_t>::max()) throw std::length_error("a plane of more than 4 GiB");
  const size_t before = packed_.size();
  packed_.resize(before + plane.size() + (plane.size() / kStoredBlock + 1) * kBlockHeader + kFlush);
  isal_zstream stream;
  isal_deflate_stateless_init(&stream);
  stream.hist_bits = 0;  // as far back as deflate allows; the call before leaves what was there
  // Levels 1 and 2 make files 8 % smaller, but (to 2.32 at least) take the address of `stream` for a byte of the data
  // when they look for the first match: the same numbers would give other bytes in every process.
  stream.level = 0;
  stream.next_in = const_cast<unsigned char*>(plane.data());  // it is only read
  stream.avail_in = static_cast<uint32_t>(plane.size());
  stream.next_out = packed_.data() + before, stream.avail_out = static_cast<uint32_t>(packed_.size() - before);
  stream.flush = FULL_FLUSH;
  stream.end_of_stream = last;
  if (isal_deflate_stateless(&stream) != COMP_OK) throw std::runtime_error("ISA-L could not deflate an array");
  packed_.resize(before + stream.total_out);
}

std::span<const unsigned char> ShuffledDeflate::pack(const unsigned char* data, uint64_t elements, size_t size) {
  shuffled_.resize(elements * size);
  shuffle(data, elements, size, shuffled_.data());
  packed_ = {0x78, 0x01};  // zlib's header: deflate, the fastest
  for (size_t plane = 0; plane < size; ++plane)
    deflate(std::span(shuffled_).subspan(plane * elements, elements), plane + 1 == size);
  const uint32_t sum = isal_adler32(1, shuffled_.data(), shuffled_.size());
  for (const int shift : {24, 16, 8, 0}) packed_.push_back(static_cast<unsigned char>(sum >> shift));
  return packed_;
}

}  // namespace scree
