#include "runtime/shuffled_deflate.h"

#include <libdeflate.h>

#include <algorithm>
#include <new>

namespace scree {

namespace {

constexpr int kLevel = 1;                // of 12
constexpr double kWorthIt = 0.5;         // bytes left of a sample: more, and they are not worth the time
constexpr uint64_t kSample = 4096;       // bytes, from the middle of a plane
constexpr uint64_t kMostStored = 65535;  // bytes in a stored block

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

void ShuffledDeflate::Free::operator()(libdeflate_compressor* c) const { libdeflate_free_compressor(c); }

ShuffledDeflate::ShuffledDeflate() : compressor_(libdeflate_alloc_compressor(kLevel)) {
  if (!compressor_) throw std::bad_alloc();
  sample_.resize(libdeflate_deflate_compress_bound(compressor_.get(), kSample));
}

bool ShuffledDeflate::is_noise(const unsigned char* plane, uint64_t bytes) {
  if (bytes <= kSample) return false;
  const size_t left = libdeflate_deflate_compress(compressor_.get(), plane + (bytes - kSample) / 2, kSample,
                                                  sample_.data(), sample_.size());
  return static_cast<double>(left) > kWorthIt * static_cast<double>(kSample);
}

void ShuffledDeflate::store(std::span<const unsigned char> bytes) {
  for (uint64_t from = 0; from < bytes.size(); from += kMostStored) {
    const auto block = bytes.subspan(from, std::min(kMostStored, bytes.size() - from));
    const auto low = static_cast<unsigned char>(block.size()), high = static_cast<unsigned char>(block.size() >> 8);
    for (const unsigned byte : {0u, unsigned{low}, unsigned{high}, ~unsigned{low}, ~unsigned{high}})  // not the last
      packed_.push_back(static_cast<unsigned char>(byte));
    packed_.insert(packed_.end(), block.begin(), block.end());
  }
}

// To the stream's end.
void ShuffledDeflate::deflate(std::span<const unsigned char> bytes) {
  const size_t before = packed_.size();
  packed_.resize(before + libdeflate_deflate_compress_bound(compressor_.get(), bytes.size()));
  packed_.resize(before + libdeflate_deflate_compress(compressor_.get(), bytes.data(), bytes.size(),
                                                      packed_.data() + before, packed_.size() - before));
}

std::span<const unsigned char> ShuffledDeflate::pack(const unsigned char* data, uint64_t elements, size_t size) {
  shuffled_.resize(elements * size);
  shuffle(data, elements, size, shuffled_.data());
  uint64_t noise = 0;
  while (noise < shuffled_.size() && is_noise(shuffled_.data() + noise, elements)) noise += elements;
  packed_ = {0x78, 0x01};
  store(std::span(shuffled_).first(noise));
  deflate(std::span(shuffled_).subspan(noise));
  const uint32_t sum = libdeflate_adler32(1, shuffled_.data(), shuffled_.size());
  for (const int shift : {24, 16, 8, 0}) packed_.push_back(static_cast<unsigned char>(sum >> shift));
  return packed_;
}

}  // namespace scree
