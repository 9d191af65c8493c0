#include "runtime/render/particle_frame.h"

#include <fstream>
#include <nlohmann/json.hpp>

#include "runtime/case_error.h"
#include "runtime/render/vtp_reader.h"

namespace scree {

namespace {

// When the run that left particles.vtp ended; NaN without a summary (a run that is going on).
double end_time(const std::filesystem::path& folder) {
  std::ifstream file(folder / "summary.json");
  const nlohmann::json summary = nlohmann::json::parse(file, nullptr, false);
  if (!summary.is_object() || !summary.contains("physical_time_s")) return std::nan("");
  return summary["physical_time_s"].is_number() ? summary["physical_time_s"].get<double>() : std::nan("");
}

ParticleField vector_field(const char* name, std::span<const ParticleState> particles, Vec3 ParticleState::*what) {
  ParticleField field{name, 3, {}};
  for (const ParticleState& p : particles)
    for (const double x : {(p.*what).x, (p.*what).y, (p.*what).z}) field.values.push_back(static_cast<float>(x));
  return field;
}

}  // namespace

const ParticleField* ParticleFrame::find(const std::string& name) const {
  for (const ParticleField& field : fields)
    if (field.name == name) return &field;
  return nullptr;
}

ParticleFrame frame_of(std::span<const ParticleState> particles, double time) {
  ParticleFrame frame;
  frame.time = time;
  ParticleField mass{"mass", 1, {}}, kind{"kind", 1, {}};
  for (const ParticleState& p : particles) {
    frame.positions.push_back(p.position), frame.radii.push_back(static_cast<float>(p.radius));
    mass.values.push_back(static_cast<float>(p.mass)), kind.values.push_back(static_cast<float>(p.kind));
  }
  frame.fields = {vector_field("velocity", particles, &ParticleState::velocity),
                  vector_field("angular_velocity", particles, &ParticleState::spin), mass, kind};
  return frame;
}

std::vector<FrameSource> list_particle_frames(const std::filesystem::path& folder) {
  std::vector<FrameSource> frames;
  if (std::filesystem::is_regular_file(folder / "particles.vtp"))
    frames.push_back({folder / "particles.vtp", end_time(folder)});
  if (frames.empty())
    throw CaseError({folder.string()}, "there are no particles here: no particles.vtp (a run writes it at its end)");
  return frames;
}

ParticleFrame read_particle_frame(const FrameSource& source) {
  ParticleFrame frame = read_vtp(source.file);
  frame.time = source.time;
  return frame;
}

}  // namespace scree
