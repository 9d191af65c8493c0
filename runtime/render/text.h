// Writing on a picture, in DejaVu Sans (which the program carries, so that no font need be installed where it runs).
#pragma once

#include <memory>
#include <string_view>

#include "runtime/render/image.h"

namespace scree {

class Font {
 public:
  explicit Font(int pixels);  // the height of a line's letters, about: the em size
  ~Font();
  Font(Font&&) noexcept;

  int pixels() const { return pixels_; }
  int width(std::string_view text) const;  // pixels; text is UTF-8
  // Writes from x on, the letters standing on the line y. Returns where the text ends.
  int draw(Image& image, int x, int y, std::string_view text, const Srgb& colour) const;

 private:
  struct Face;
  int layout(std::string_view text, Image* image, int x, int y, const Srgb& colour) const;
  int pixels_;
  std::unique_ptr<Face> face_;
};

}  // namespace scree
