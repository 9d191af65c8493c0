// Particles from a CSV file. The first line that is neither empty nor a '#' comment names the columns, in any order:
//     x, y, z      m, position of the centre
//     radius | r   m
//     vx, vy, vz   m/s, optional (all three or none; 0 without them)
//     kind         a particle kind's name, optional
#pragma once

#include <string>
#include <vector>

#include "geometry/vec.h"
#include "runtime/case_error.h"

namespace scree {

struct CsvParticle {
  Vec3 position;           // m
  double radius;           // m
  Vec3 velocity{0, 0, 0};  // m/s
  std::string kind;        // empty: the file does not say
  int line = 0;            // where it stands
};

// Throws CaseError with file, line and column.
std::vector<CsvParticle> read_particles_csv(const std::string& path);
std::vector<CsvParticle> read_particles_csv(const std::string& path, std::string text);  // with its text at hand

}  // namespace scree
