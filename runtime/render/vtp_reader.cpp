#include "runtime/render/vtp_reader.h"

#include <cstring>
#include <fstream>
#include <optional>

#include "runtime/base64.h"
#include "runtime/case_error.h"

namespace scree {

namespace {

struct DataArray {
  std::string name, type;
  size_t components = 1;
  std::string_view text;  // base64
};

class File {
 public:
  explicit File(const std::filesystem::path& path) : path_(path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) fail("cannot be read");
    content_.assign(std::istreambuf_iterator<char>(file), {});
    if (content_.find("type=\"PolyData\"") == std::string::npos ||
        content_.find("format=\"binary\"") == std::string::npos)
      fail("is not VTK PolyData with arrays in base64");
  }

  [[noreturn]] void fail(const std::string& problem) const { throw CaseError({path_.string()}, problem); }

  std::vector<DataArray> arrays() const {
    std::vector<DataArray> arrays;
    const std::string_view content(content_);
    for (size_t at = 0; (at = content.find("<DataArray ", at)) != content.npos;) {
      const size_t start = content.find('>', at), end = content.find('<', start);
      const std::string_view tag = content.substr(at, start - at);
      const std::string name = attribute(tag, "Name").value_or("");
      if (end == content.npos) fail(fmt::format("array '{}' is cut off", name));
      arrays.push_back({name, attribute(tag, "type").value_or(""),
                        number(attribute(tag, "NumberOfComponents").value_or("1")),
                        content.substr(start + 1, end - start - 1)});
      at = end;
    }
    return arrays;
  }

  // The values of an array that must hold `count` times its components.
  template <class T>
  std::vector<T> values(const DataArray& array, size_t count) const {
    if (array.type == "Float32") return converted<T, float>(array, count);
    if (array.type == "Float64") return converted<T, double>(array, count);
    if (array.type == "Int32") return converted<T, int32_t>(array, count);
    if (array.type == "Int64") return converted<T, int64_t>(array, count);
    if (array.type == "UInt8") return converted<T, uint8_t>(array, count);
    fail(fmt::format("array '{}' is of type {}, which is not known here", array.name, array.type));
  }

  size_t points() const { return number(attribute(content_, "NumberOfPoints").value_or("")); }

 private:
  static std::optional<std::string> attribute(std::string_view tag, const std::string& name) {
    const std::string key = " " + name + "=\"";
    const size_t at = tag.find(key);
    if (at == std::string_view::npos) return std::nullopt;
    const size_t start = at + key.size();
    return std::string(tag.substr(start, tag.find('"', start) - start));
  }
  size_t number(const std::string& text) const {
    if (text.empty() || text.size() > 15 || text.find_first_not_of("0123456789") != std::string::npos)
      fail(fmt::format("has '{}' where a number should be", text));
    return std::stoull(text);
  }
  template <class T, class Stored>
  std::vector<T> converted(const DataArray& array, size_t count) const {
    uint64_t size = 0;
    const size_t wanted = count * array.components * sizeof(Stored);
    const std::optional<std::string> bytes = from_base64(array.text);
    if (!bytes) fail(fmt::format("array '{}' is not base64", array.name));
    if (bytes->size() >= sizeof size) std::memcpy(&size, bytes->data(), sizeof size);
    if (size != wanted || bytes->size() != sizeof size + wanted)
      fail(fmt::format("array '{}' is cut off, or not of {} points", array.name, count));
    std::vector<T> values(count * array.components);
    for (size_t k = 0; k < values.size(); ++k) {
      Stored value;
      std::memcpy(&value, bytes->data() + sizeof size + k * sizeof value, sizeof value);
      values[k] = static_cast<T>(value);
    }
    return values;
  }

  std::filesystem::path path_;
  std::string content_;
};

}  // namespace

ParticleFrame read_vtp(const std::filesystem::path& path) {
  const File file(path);
  const size_t count = file.points();
  ParticleFrame frame;
  for (const DataArray& array : file.arrays()) {
    if (array.name == "Points") {
      const std::vector<double> x = file.values<double>(array, count);
      for (size_t k = 0; k < count; ++k) frame.positions.push_back({x[3 * k], x[3 * k + 1], x[3 * k + 2]});
    } else if (array.name == "radius") {
      frame.radii = file.values<float>(array, count);
    } else if (array.name != "connectivity" && array.name != "offsets") {
      frame.fields.push_back({array.name, static_cast<int>(array.components), file.values<float>(array, count)});
    }
  }
  if (frame.positions.size() != count || frame.radii.size() != count) file.fail("has no array 'Points' or 'radius'");
  return frame;
}

}  // namespace scree
