// The only file that names FreeType.
#include "runtime/render/text.h"

#include <fmt/format.h>
#include <ft2build.h>

#include <stdexcept>
#include FT_FREETYPE_H

// The font's file as it is, between two addresses.
asm(".section .rodata\n"
    ".global scree_font_begin\n.global scree_font_end\n"
    "scree_font_begin:\n.incbin \"" SCREE_FONT
    "\"\nscree_font_end:\n"
    ".previous\n");
extern "C" const unsigned char scree_font_begin[], scree_font_end[];

namespace scree {

struct Font::Face {
  FT_Library library = nullptr;
  FT_Face face = nullptr;
  ~Face() {
    if (face) FT_Done_Face(face);
    if (library) FT_Done_FreeType(library);
  }
};

namespace {

void require_success(FT_Error error, const char* what) {
  if (error) throw std::runtime_error(fmt::format("FreeType cannot {} (error {})", what, error));
}

// The next character of UTF-8 text, which is cut off `text`; what is not UTF-8 is shown as a question mark.
char32_t next_character(std::string_view& text) {
  const auto byte = [&](size_t k) { return k < text.size() ? static_cast<unsigned char>(text[k]) : 0u; };
  const unsigned first = byte(0);
  const size_t length = first < 0x80 ? 1 : first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : first >= 0xc0 ? 2 : 0;
  char32_t character = length == 1 ? first : first & (0x7fu >> length);
  bool valid = length > 0 && length <= text.size();
  for (size_t k = 1; valid && k < length; ++k) {
    valid = (byte(k) & 0xc0) == 0x80;
    character = (character << 6) | (byte(k) & 0x3f);
  }
  text.remove_prefix(valid ? length : 1);
  return valid ? character : U'?';
}

}  // namespace

Font::Font(int pixels) : pixels_(pixels), face_(std::make_unique<Face>()) {
  require_success(FT_Init_FreeType(&face_->library), "start");
  require_success(
      FT_New_Memory_Face(face_->library, scree_font_begin, scree_font_end - scree_font_begin, 0, &face_->face),
      "read its font");
  require_success(FT_Set_Pixel_Sizes(face_->face, 0, static_cast<FT_UInt>(pixels)), "set a size");
}
Font::~Font() = default;
Font::Font(Font&&) noexcept = default;

int Font::layout(std::string_view text, Image* image, int x, int y, const Srgb& colour) const {
  const FT_Face face = face_->face;
  FT_UInt previous = 0;
  while (!text.empty()) {
    const FT_UInt glyph = FT_Get_Char_Index(face, next_character(text));
    FT_Vector kerning{};
    if (previous) FT_Get_Kerning(face, previous, glyph, FT_KERNING_DEFAULT, &kerning);
    previous = glyph;
    // Light hinting puts horizontal strokes on whole pixels: crisp at small sizes, shapes kept.
    require_success(FT_Load_Glyph(face, glyph, FT_LOAD_TARGET_LIGHT | (image ? FT_LOAD_RENDER : 0)), "draw a letter");
    x += static_cast<int>(kerning.x >> 6);
    const FT_Bitmap& bitmap = face->glyph->bitmap;
    for (unsigned row = 0; image && row < bitmap.rows; ++row)
      for (unsigned column = 0; column < bitmap.width; ++column)
        image->blend(x + face->glyph->bitmap_left + static_cast<int>(column),
                     y - face->glyph->bitmap_top + static_cast<int>(row), colour,
                     bitmap.buffer[static_cast<int>(row) * bitmap.pitch + static_cast<int>(column)] / 255.0f);
    x += static_cast<int>(face->glyph->advance.x >> 6);
  }
  return x;
}

int Font::width(std::string_view text) const { return layout(text, nullptr, 0, 0, {}); }

int Font::draw(Image& image, int x, int y, std::string_view text, const Srgb& colour) const {
  return layout(text, &image, x, y, colour);
}

}  // namespace scree
