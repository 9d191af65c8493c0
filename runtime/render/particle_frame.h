// The particles of one moment, as files of results hold them: positions, radii, and whatever fields there are.
#pragma once

#include <cmath>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "runtime/engine.h"

namespace scree {

struct ParticleField {
  std::string name;
  int components = 1;
  std::vector<float> values;  // components of particle 0, then 1, ...
};

struct ParticleFrame {
  double time = std::nan("");  // s; NaN: not known
  std::vector<Vec3> positions;
  std::vector<float> radii;
  std::vector<ParticleField> fields;

  size_t count() const { return positions.size(); }
  const ParticleField* find(const std::string& name) const;  // null: there is none
};

// Velocity, angular_velocity, mass and kind.
ParticleFrame frame_of(std::span<const ParticleState> particles, double time);

// Where a moment can be read from.
struct FrameSource {
  std::filesystem::path file;
  double time = std::nan("");  // s; NaN: not known
};

// The moments that a results folder holds, by time. Throws CaseError if there is none.
std::vector<FrameSource> list_particle_frames(const std::filesystem::path& folder);

// Throws CaseError naming the file and what is wrong with it.
ParticleFrame read_particle_frame(const FrameSource& source);

}  // namespace scree
