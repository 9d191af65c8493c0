#include "runtime/shuffled_deflate.h"

#include <isa-l/igzip_lib.h>

#include <algorithm>
#include <limits>
#include <memory>
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

constexpr size_t kStoredBlock = 65535, kBlockHeader = 5;  // bytes
constexpr size_t kFlush = 64;                             // bytes, more than what ends a plane

size_t most_packed(size_t plane) { return plane + (plane / kStoredBlock + 1) * kBlockHeader + kFlush; }

// Both return the end of what they wrote, a whole byte. Neither refers to the planes before.
unsigned char* deflate(const unsigned char* plane, size_t bytes, bool last, unsigned char* to) {
  isal_zstream stream;
  isal_deflate_stateless_init(&stream);
  stream.hist_bits = 0;  // as far back as deflate allows; the call before leaves what was there
  // Levels 1 and 2 make files 8 % smaller, but (to 2.32 at least) take the address of `stream` for a byte of the data
  // when they look for the first match: the same numbers would give other bytes in every process.
  stream.level = 0;
  stream.next_in = const_cast<unsigned char*>(plane);  // it is only read
  stream.avail_in = static_cast<uint32_t>(bytes);
  stream.next_out = to, stream.avail_out = static_cast<uint32_t>(most_packed(bytes));
  stream.flush = FULL_FLUSH;
  stream.end_of_stream = last;
  if (isal_deflate_stateless(&stream) != COMP_OK) throw std::runtime_error("ISA-L could not deflate an array");
  return to + stream.total_out;
}

unsigned char* store(const unsigned char* plane, size_t bytes, bool last, unsigned char* to) {
  for (size_t at = 0; at < bytes; at += kStoredBlock) {
    const size_t size = std::min(kStoredBlock, bytes - at);
    *to++ = last && at + size == bytes;
    for (const size_t length : {size, ~size})
      *to++ = static_cast<unsigned char>(length), *to++ = static_cast<unsigned char>(length >> 8);
    to = std::copy_n(plane + at, size, to);
  }
  return to;
}

// Whether samples from all over the plane shrink by less than three tenths (their code's own header, a tenth and more,
// counts against them): deflating such a plane takes longer than writing what it would save.
bool is_noise(const unsigned char* plane, size_t bytes) {
  constexpr size_t kSample = 256, kSamples = 4;
  if (bytes < 4 * kSamples * kSample) return false;
  unsigned char samples[kSamples * kSample], packed[sizeof samples + kBlockHeader + kFlush];
  for (size_t k = 0; k < kSamples; ++k)
    std::copy_n(plane + (bytes - kSample) * k / (kSamples - 1), kSample, samples + kSample * k);
  return 10 * (deflate(samples, sizeof samples, true, packed) - packed) >= 7 * std::ssize(samples);
}

}  // namespace

std::vector<unsigned char> shuffled_deflate(const unsigned char* data, uint64_t elements, size_t size) {
  constexpr size_t kHeader = 2, kTrailer = 4;
  if (elements > std::numeric_limits<uint32_t>::max() / 2) throw std::length_error("a plane of more than 2 GiB");
  const auto shuffled = std::make_unique_for_overwrite<unsigned char[]>(elements * size);
  const auto packed =
      std::make_unique_for_overwrite<unsigned char[]>(kHeader + size * most_packed(elements) + kTrailer);
  shuffle(data, elements, size, shuffled.get());
  unsigned char* to = packed.get();
  *to++ = 0x78, *to++ = 0x01;  // zlib's header: deflate, the fastest
  for (size_t plane = 0; plane < size; ++plane) {
    const unsigned char* from = shuffled.get() + plane * elements;
    to = (is_noise(from, elements) ? store : deflate)(from, elements, plane + 1 == size, to);
  }
  const uint32_t sum = isal_adler32(1, shuffled.get(), elements * size);
  for (const int shift : {24, 16, 8, 0}) *to++ = static_cast<unsigned char>(sum >> shift);
  return {packed.get(), to};
}

}  // namespace scree
