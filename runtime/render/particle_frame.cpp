#include "runtime/render/particle_frame.h"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "runtime/case_error.h"
#include "runtime/render/vtp_reader.h"
#include "runtime/run_folder.h"
#include "runtime/vtkhdf_reader.h"

namespace scree {

namespace {

// When the run that left particles.vtp ended; NaN without a summary (a run that is going on).
double end_time(const std::filesystem::path& folder) {
  std::ifstream file(folder / "summary.json");
  const nlohmann::json summary = nlohmann::json::parse(file, nullptr, false);
  if (!summary.is_object() || !summary.contains("physical_time_s")) return std::nan("");
  return summary["physical_time_s"].is_number() ? summary["physical_time_s"].get<double>() : std::nan("");
}

double time_of_field_file(const std::filesystem::path& path) {
  try {
    const std::vector<double> time = VtkHdfReader(path).read("FieldData/time").values;
    return time.empty() ? std::nan("") : time[0];
  } catch (const Hdf5Error& e) {
    throw CaseError({path.string()}, e.what());
  }
}

// What runtime/particle_fields.h wrote. The ids stay behind: they are no quantity to colour by.
ParticleFrame read_field_file(const std::filesystem::path& path) {
  try {
    VtkHdfReader file(path);
    ParticleFrame frame;
    const VtkHdfReader::Rows points = file.read("Points");
    if (points.components != 3) throw Hdf5Error("Points: not rows of three coordinates");
    for (uint64_t k = 0; k < points.count; ++k)
      frame.positions.push_back({points.values[3 * k], points.values[3 * k + 1], points.values[3 * k + 2]});
    for (const std::string& name : file.point_data()) {
      if (name == "id") continue;
      VtkHdfReader::Rows rows = file.read("PointData/" + name);
      if (rows.count != points.count) throw Hdf5Error(name + ": not a row for each point");
      std::vector<float> values(rows.values.begin(), rows.values.end());
      if (name == "radius")
        frame.radii = std::move(values);
      else
        frame.fields.push_back({name, rows.components, std::move(values)});
    }
    if (frame.radii.size() != points.count) throw Hdf5Error("there is no PointData/radius");
    return frame;
  } catch (const Hdf5Error& e) {
    throw CaseError({path.string()}, e.what());
  }
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
  for (const std::filesystem::path& file : entries_of(folder / "fields"))
    if (file.filename().string().starts_with("particles_") && file.extension() == ".vtkhdf")
      frames.push_back({file, time_of_field_file(file)});
  std::ranges::stable_sort(frames, {}, &FrameSource::time);
  const FrameSource last{folder / "particles.vtp", end_time(folder)};
  if (std::filesystem::is_regular_file(last.file) && (frames.empty() || !(last.time <= frames.back().time)))
    frames.push_back(last);  // a field file of the same moment says more
  if (frames.empty())
    throw CaseError({folder.string()},
                    "there are no particles here: neither particles.vtp (a run writes it at its end) nor "
                    "fields/particles_*.vtkhdf ([output.fields])");
  return frames;
}

ParticleFrame read_particle_frame(const FrameSource& source) {
  ParticleFrame frame = source.file.extension() == ".vtkhdf" ? read_field_file(source.file) : read_vtp(source.file);
  frame.time = source.time;
  return frame;
}

}  // namespace scree
