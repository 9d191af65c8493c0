#include "runtime/results.h"

#include <bit>
#include <cerrno>
#include <cstring>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "runtime/base64.h"

namespace scree {

namespace {

[[noreturn]] void fail(const std::filesystem::path& path, int error) {
  throw RunError(fmt::format("cannot write {}: {}", path.string(), std::strerror(error)));
}

}  // namespace

CsvWriter::CsvWriter(const std::filesystem::path& path, const std::vector<std::string>& columns)
    : path_(path), file_(std::fopen(path.c_str(), "w")) {
  if (!file_) fail(path_, errno);
  check(std::fputs(fmt::format("{}\n", fmt::join(columns, ",")).c_str(), file_.get()));
}

void CsvWriter::row(std::span<const double> values) {
  std::string line;
  for (size_t k = 0; k < values.size(); ++k) line += fmt::format("{}{:.9g}", k ? "," : "", values[k]);
  check(std::fputs((line + "\n").c_str(), file_.get()));
}

void CsvWriter::check(int written) const {
  if (written < 0 || std::fflush(file_.get()) != 0) fail(path_, errno);
}

OutputFile::OutputFile(const std::filesystem::path& path)
    : path_(path), temporary_(path.string() + ".part"), file_(std::fopen(temporary_.c_str(), "wb")) {
  if (!file_) scree::fail(path_, errno);
}

OutputFile::~OutputFile() {
  if (!file_) return;
  std::fclose(file_);
  std::remove(temporary_.c_str());
}

void OutputFile::write(std::string_view content) {
  if (std::fwrite(content.data(), 1, content.size(), file_) != content.size()) scree::fail(path_, errno);
}

void OutputFile::finish() {
  if (std::fflush(file_) != 0) scree::fail(path_, errno);
  std::FILE* const file = std::exchange(file_, nullptr);
  // A network file system may say only now that the disk is full.
  if (std::fclose(file) == 0 && std::rename(temporary_.c_str(), path_.c_str()) == 0) return;
  const int error = errno;
  std::remove(temporary_.c_str());
  scree::fail(path_, error);
}

void write_file(const std::filesystem::path& path, std::string_view content) {
  OutputFile file(path);
  file.write(content);
  file.finish();
}

namespace {

// An array of a VTK XML file, uncompressed: byte count (UInt64) and bytes as one base64 text. In pieces, so that ten
// million particles need no second copy.
template <class T, class Get>
void write_array(OutputFile& file, std::string_view name, int components, size_t count, const Get& get) {
  constexpr const char* kType = std::is_same_v<T, float>    ? "Float32"
                                : std::is_same_v<T, double> ? "Float64"
                                : sizeof(T) == 4            ? "Int32"
                                                            : "Int64";
  constexpr size_t kPiece = 3 << 14;  // B; a multiple of 3, so that texts can be strung together
  std::string bytes;
  const auto append = [&](auto value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    if (bytes.size() < kPiece) return;
    file.write(base64(std::string_view(bytes).substr(0, kPiece)));
    bytes.erase(0, kPiece);
  };
  file.write(fmt::format(R"(<DataArray type="{}" Name="{}" NumberOfComponents="{}" format="binary">)", kType, name,
                         components));
  append(uint64_t{count * components * sizeof(T)});
  for (size_t k = 0; k < count; ++k)
    for (int c = 0; c < components; ++c) append(static_cast<T>(get(k, c)));
  file.write(base64(bytes) + "</DataArray>\n");
}

double component(const Vec3& v, int c) { return c == 0 ? v.x : c == 1 ? v.y : v.z; }

}  // namespace

void write_particles_vtp(const std::filesystem::path& path, size_t n, const ParticleAt& p) {
  OutputFile file(path);
  const char* order = std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian";
  file.write(
      fmt::format("<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"{}\" "
                  "header_type=\"UInt64\">\n"
                  "<PolyData><Piece NumberOfPoints=\"{}\" NumberOfVerts=\"{}\" NumberOfLines=\"0\" "
                  "NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n"
                  "<PointData Scalars=\"radius\" Vectors=\"velocity\">\n",
                  order, n, n));
  write_array<float>(file, "radius", 1, n, [&](size_t k, int) { return p(k).radius; });
  write_array<float>(file, "velocity", 3, n, [&](size_t k, int c) { return component(p(k).velocity, c); });
  write_array<float>(file, "angular_velocity", 3, n, [&](size_t k, int c) { return component(p(k).spin, c); });
  write_array<float>(file, "mass", 1, n, [&](size_t k, int) { return p(k).mass; });
  write_array<int64_t>(file, "id", 1, n, [&](size_t k, int) { return p(k).id; });
  write_array<int32_t>(file, "kind", 1, n, [&](size_t k, int) { return p(k).kind; });
  file.write("</PointData>\n<Points>\n");
  write_array<double>(file, "Points", 3, n, [&](size_t k, int c) { return component(p(k).position, c); });
  file.write("</Points>\n<Verts>\n");
  write_array<int64_t>(file, "connectivity", 1, n, [](size_t k, int) { return k; });
  write_array<int64_t>(file, "offsets", 1, n, [](size_t k, int) { return k + 1; });
  file.write("</Verts>\n</Piece></PolyData>\n</VTKFile>\n");
  file.finish();
}

void write_neighbourhood_vtp(const std::filesystem::path& path, const Engine& engine, const Vec3& where, double reach) {
  std::vector<ParticleState> near;
  for (const ParticleState& p : each_particle(engine))
    if (!(norm(p.position - where) > reach)) near.push_back(p);  // with those whose position is not a number
  write_particles_vtp(path, near);
}

}  // namespace scree
