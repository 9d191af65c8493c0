// A picture: rows from the top, 8 bits a channel, sRGB. And colours in linear light, which is what shading adds up.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace scree {

using Srgb = std::array<uint8_t, 3>;

struct Rgb {  // linear light, 0 to 1
  float r = 0, g = 0, b = 0;
};
inline Rgb operator+(const Rgb& a, const Rgb& b) { return {a.r + b.r, a.g + b.g, a.b + b.b}; }
inline Rgb operator*(float s, const Rgb& a) { return {s * a.r, s * a.g, s * a.b}; }
inline Rgb mix(const Rgb& a, const Rgb& b, float share_of_b) { return (1 - share_of_b) * a + share_of_b * b; }

// IEC 61966-2-1.
inline float to_linear(float srgb) {
  return srgb <= 0.04045f ? srgb / 12.92f : std::pow((srgb + 0.055f) / 1.055f, 2.4f);
}
inline float to_srgb(float linear) {
  return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}
inline uint8_t to_byte(float x) { return static_cast<uint8_t>(std::lround(255 * std::clamp(x, 0.0f, 1.0f))); }
inline Rgb to_linear(const Srgb& c) {
  return {to_linear(c[0] / 255.0f), to_linear(c[1] / 255.0f), to_linear(c[2] / 255.0f)};
}
inline Srgb to_srgb(const Rgb& c) { return {to_byte(to_srgb(c.r)), to_byte(to_srgb(c.g)), to_byte(to_srgb(c.b))}; }

class Image {
 public:
  Image(int width, int height) : width_(width), height_(height), bytes_(size_t{3} * width * height) {}

  int width() const { return width_; }
  int height() const { return height_; }
  Srgb at(int x, int y) const {
    const uint8_t* p = &bytes_[offset(x, y)];
    return {p[0], p[1], p[2]};
  }
  void set(int x, int y, const Srgb& c) { std::copy(c.begin(), c.end(), &bytes_[offset(x, y)]); }
  // Lays c over the pixel, `coverage` from 0 to 1. Outside the picture: nothing.
  void blend(int x, int y, const Srgb& c, float coverage) {
    if (x < 0 || y < 0 || x >= width_ || y >= height_) return;
    uint8_t* p = &bytes_[offset(x, y)];
    for (int k = 0; k < 3; ++k) p[k] = static_cast<uint8_t>(std::lround(p[k] + coverage * (c[k] - p[k])));
  }
  void fill(int x0, int y0, int x1, int y1, const Srgb& c, float coverage = 1) {
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x) blend(x, y, c, coverage);
  }
  const std::vector<uint8_t>& bytes() const { return bytes_; }
  bool operator==(const Image&) const = default;

 private:
  size_t offset(int x, int y) const { return 3 * (size_t(y) * width_ + x); }
  int width_, height_;
  std::vector<uint8_t> bytes_;
};

// A whole file or none. Throws RunError (runtime/engine.h) naming the file and the reason.
void write_png(const std::filesystem::path& path, const Image& image);
Image read_png(const std::filesystem::path& path);

}  // namespace scree
