#include "runtime/report_pictures.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>

#include "runtime/base64.h"
#include "runtime/run_folder.h"

namespace scree {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPngSignature = "\x89PNG\r\n\x1a\n";
constexpr size_t kPngHeaderBytes = 24;  // signature, length and type of IHDR, width, height (big-endian)

uint32_t big_endian(std::string_view bytes) {
  uint32_t value = 0;
  for (const char c : bytes.substr(0, 4)) value = value << 8 | static_cast<unsigned char>(c);
  return value;
}

std::string read_bytes(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream bytes;
  bytes << stream.rdbuf();
  return bytes.str();
}

// "front_speed_0012.png" belongs to the series "front_speed_".
std::string series_of(const fs::path& path) {
  const std::string stem = path.stem().string();
  return stem.substr(0, stem.find_last_not_of("0123456789.") + 1);
}

// Of each series first and last and evenly what lies between, so that all series together have at most `count`.
std::vector<fs::path> spread(const std::vector<fs::path>& files, size_t count) {
  std::map<std::string, std::vector<fs::path>> series;
  for (const fs::path& file : files) series[series_of(file)].push_back(file);
  const size_t share = std::max<size_t>(1, count / std::max<size_t>(1, series.size()));
  std::vector<fs::path> chosen;
  for (const auto& [name, members] : series) {
    const size_t n = std::min(share, members.size());
    for (size_t k = 0; k < n && chosen.size() < count; ++k)
      chosen.push_back(members[n == 1 ? members.size() - 1 : k * (members.size() - 1) / (n - 1)]);
  }
  return chosen;
}

std::vector<fs::path> png_files(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (const fs::path& path : entries_of(folder))
    if (path.extension() == ".png" && fs::is_regular_file(path, error)) files.push_back(path);
  return files;
}

}  // namespace

ReportJson pictures_of(const fs::path& folder, const PictureBudget& budget) {
  ReportJson result = ReportJson::array();
  uint64_t bytes_left = budget.bytes;
  for (const char* name : kPictureFolders) {
    const std::vector<fs::path> files = png_files(folder / name);
    size_t shown = 0;
    for (const fs::path& file : spread(files, budget.count)) {
      std::error_code error;
      const uint64_t size = fs::file_size(file, error);
      if (error || size > bytes_left) continue;
      const std::string bytes = read_bytes(file);
      if (bytes.size() < kPngHeaderBytes || !bytes.starts_with(kPngSignature)) continue;  // not written to its end
      bytes_left -= std::min<uint64_t>(bytes.size(), bytes_left), ++shown;
      result.push_back({{"folder", name},
                        {"file", file.filename().string()},
                        {"width", big_endian(std::string_view(bytes).substr(16))},
                        {"height", big_endian(std::string_view(bytes).substr(20))},
                        {"uri", "data:image/png;base64," + base64(bytes)}});
    }
    if (shown < files.size()) result.push_back({{"folder", name}, {"left_out", files.size() - shown}});
  }
  return result;
}

}  // namespace scree
