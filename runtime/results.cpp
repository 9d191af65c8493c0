#include "runtime/results.h"

#include <bit>
#include <cerrno>
#include <cstring>

#include <fmt/format.h>

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

void write_file(const std::filesystem::path& path, std::string_view content) {
  const std::filesystem::path temporary = path.string() + ".part";
  std::FILE* f = std::fopen(temporary.c_str(), "wb");
  if (!f) fail(path, errno);
  const bool written = std::fwrite(content.data(), 1, content.size(), f) == content.size() && std::fflush(f) == 0;
  int error = errno;
  const bool closed = std::fclose(f) == 0;  // a network file system may say only now that the disk is full
  if (written && !closed) error = errno;
  if (written && closed && std::rename(temporary.c_str(), path.c_str()) == 0) return;
  if (written && closed) error = errno;
  std::remove(temporary.c_str());
  fail(path, error);
}

namespace {

// Raw appended data: each array's byte count (UInt64), then its bytes, in the machine's byte order.
class AppendedData {
 public:
  template <class T, class Get>
  std::string array(std::string_view name, std::string_view type, int components, size_t count, const Get& get) {
    const std::string header =
        fmt::format(R"(<DataArray type="{}" Name="{}" NumberOfComponents="{}" format="appended" offset="{}"/>)", type,
                    name, components, bytes_.size());
    const uint64_t size = count * components * sizeof(T);
    append(&size, sizeof size);
    for (size_t k = 0; k < count; ++k)
      for (int c = 0; c < components; ++c) {
        const T value = static_cast<T>(get(k, c));
        append(&value, sizeof value);
      }
    return header + "\n";
  }
  const std::string& bytes() const { return bytes_; }

 private:
  void append(const void* p, size_t size) { bytes_.append(static_cast<const char*>(p), size); }
  std::string bytes_;
};

double component(const Vec3& v, int c) { return c == 0 ? v.x : c == 1 ? v.y : v.z; }

}  // namespace

void write_particles_vtp(const std::filesystem::path& path, std::span<const ParticleState> p) {
  AppendedData data;
  const size_t n = p.size();
  std::string point_data, points, verts;
  point_data += data.array<float>("radius", "Float32", 1, n, [&](size_t k, int) { return p[k].radius; });
  point_data +=
      data.array<float>("velocity", "Float32", 3, n, [&](size_t k, int c) { return component(p[k].velocity, c); });
  point_data +=
      data.array<float>("angular_velocity", "Float32", 3, n, [&](size_t k, int c) { return component(p[k].spin, c); });
  point_data += data.array<float>("mass", "Float32", 1, n, [&](size_t k, int) { return p[k].mass; });
  point_data += data.array<int64_t>("id", "Int64", 1, n, [&](size_t k, int) { return p[k].id; });
  point_data += data.array<int32_t>("kind", "Int32", 1, n, [&](size_t k, int) { return p[k].kind; });
  points += data.array<double>("Points", "Float64", 3, n, [&](size_t k, int c) { return component(p[k].position, c); });
  verts += data.array<int64_t>("connectivity", "Int64", 1, n, [](size_t k, int) { return k; });
  verts += data.array<int64_t>("offsets", "Int64", 1, n, [](size_t k, int) { return k + 1; });
  const char* order = std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian";
  write_file(path,
             fmt::format("<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"{}\" "
                         "header_type=\"UInt64\">\n"
                         "<PolyData><Piece NumberOfPoints=\"{}\" NumberOfVerts=\"{}\" NumberOfLines=\"0\" "
                         "NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n"
                         "<PointData Scalars=\"radius\" "
                         "Vectors=\"velocity\">\n{}</PointData>\n<Points>\n{}</Points>\n<Verts>\n{}</Verts>\n"
                         "</Piece></PolyData>\n<AppendedData encoding=\"raw\">\n_{}\n</AppendedData>\n</VTKFile>\n",
                         order, n, n, point_data, points, verts, data.bytes()));
}

void write_neighbourhood_vtp(const std::filesystem::path& path, std::span<const ParticleState> particles,
                             const Vec3& where, double reach) {
  std::vector<ParticleState> near;
  for (const ParticleState& p : particles)
    if (!(norm(p.position - where) > reach)) near.push_back(p);  // with those whose position is not a number
  write_particles_vtp(path, near);
}

}  // namespace scree
