// The output folder: what a run leaves behind, written as it goes.
#pragma once

#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "runtime/mass_flow.h"

namespace scree {

// A CSV file of numbers. Every row is checked: a full disk is a RunError, not a short file.
class CsvWriter {
 public:
  CsvWriter(const std::filesystem::path& path, const std::vector<std::string>& columns);
  void row(std::span<const double> values);

 private:
  void check(int written) const;
  struct Close {
    void operator()(std::FILE* f) const { std::fclose(f); }
  };
  std::filesystem::path path_;
  std::unique_ptr<std::FILE, Close> file_;
};

// Writes a whole file, to a temporary name first. Throws as OutputFile does.
void write_file(const std::filesystem::path& path, std::string_view content);

// A file that takes its name only when it is whole. Throws RunError naming the file and the reason.
class OutputFile {
 public:
  explicit OutputFile(const std::filesystem::path& path);  // under a temporary name
  ~OutputFile();                                           // unless finished, nothing stays
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  void write(std::string_view content);
  void finish();

 private:
  std::filesystem::path path_, temporary_;
  std::FILE* file_;
};

// Particles as VTK PolyData (.vtp, XML): points with radius, velocity, angular_velocity, id, kind, mass. Opens in
// ParaView (Glyph: sphere, scale by radius). Arrays are base64 in place, uncompressed, as OVITO's reader wants them.
using ParticleAt = std::function<ParticleState(size_t)>;
void write_particles_vtp(const std::filesystem::path& path, size_t count, const ParticleAt& particle);
inline void write_particles_vtp(const std::filesystem::path& path, std::span<const ParticleState> particles) {
  write_particles_vtp(path, particles.size(), [&](size_t k) { return particles[k]; });
}

// The particles with their centres within `reach` (m) of `where`, the same way.
void write_neighbourhood_vtp(const std::filesystem::path& path, const Engine& engine, const Vec3& where, double reach);

}  // namespace scree
