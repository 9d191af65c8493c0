#include "runtime/base64.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace scree {

namespace {

constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr uint32_t kForeign = 64;

constexpr std::array<uint8_t, 256> kValues = [] {
  std::array<uint8_t, 256> values{};
  values.fill(kForeign);
  for (size_t k = 0; k < kDigits.size(); ++k) values[static_cast<unsigned char>(kDigits[k])] = k;
  return values;
}();

}  // namespace

std::string base64(std::string_view bytes) {
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t k = 0; k < bytes.size(); k += 3) {
    const size_t n = std::min<size_t>(3, bytes.size() - k);
    uint32_t three = 0;
    for (size_t j = 0; j < 3; ++j) three = three << 8 | (j < n ? static_cast<unsigned char>(bytes[k + j]) : 0u);
    for (size_t j = 0; j < 4; ++j) text += j <= n ? kDigits[three >> (18 - 6 * j) & 63] : '=';
  }
  return text;
}

std::optional<std::string> from_base64(std::string_view text) {
  if (text.size() % 4 != 0) return std::nullopt;
  const size_t padding = text.ends_with("==") ? 2 : text.ends_with("=") ? 1 : 0;
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3);
  for (size_t k = 0; k < text.size(); k += 4) {
    const size_t digits = k + 4 < text.size() ? 4 : 4 - padding;
    uint32_t three = 0;
    for (size_t j = 0; j < 4; ++j) {
      const uint32_t value = j < digits ? kValues[static_cast<unsigned char>(text[k + j])] : 0u;
      if (value == kForeign) return std::nullopt;
      three = three << 6 | value;
    }
    for (size_t j = 0; j + 1 < digits; ++j) bytes += static_cast<char>(three >> (16 - 8 * j));
  }
  return bytes;
}

}  // namespace scree
