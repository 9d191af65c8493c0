// The only file that names libpng.
#include <fmt/format.h>
#include <png.h>

#include "runtime/render/image.h"
#include "runtime/results.h"

namespace scree {

namespace {

png_image described(const Image& image) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(image.width()), png.height = static_cast<png_uint_32>(image.height());
  png.format = PNG_FORMAT_RGB;
  return png;
}

}  // namespace

void write_png(const std::filesystem::path& path, const Image& image) {
  png_image png = described(image);
  const auto encode = [&](void* memory, png_alloc_size_t& size) {
    if (!png_image_write_to_memory(&png, memory, &size, 0, image.bytes().data(), 0, nullptr))
      throw RunError(fmt::format("cannot write {}: {}", path.string(), png.message));
  };
  std::string file(image.bytes().size() + 4096, '\0');  // more than a picture of noise needs, nearly always
  png_alloc_size_t size = file.size();
  if (!png_image_write_to_memory(&png, file.data(), &size, 0, image.bytes().data(), 0, nullptr)) {
    png = described(image);
    encode(nullptr, size);
    file.resize(size);
    encode(file.data(), size);
  }
  file.resize(size);
  write_file(path, file);
}

Image read_png(const std::filesystem::path& path) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  if (!png_image_begin_read_from_file(&png, path.c_str()))
    throw RunError(fmt::format("cannot read {}: {}", path.string(), png.message));
  png.format = PNG_FORMAT_RGB;
  std::vector<uint8_t> bytes(PNG_IMAGE_SIZE(png));
  if (!png_image_finish_read(&png, nullptr, bytes.data(), 0, nullptr))
    throw RunError(fmt::format("cannot read {}: {}", path.string(), png.message));
  Image image(static_cast<int>(png.width), static_cast<int>(png.height));
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) {
      const uint8_t* p = &bytes[3 * (size_t(y) * image.width() + x)];
      image.set(x, y, {p[0], p[1], p[2]});
    }
  return image;
}

}  // namespace scree
