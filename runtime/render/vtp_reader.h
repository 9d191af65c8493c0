// Reads back particles.vtp (runtime/results.h writes it).
#pragma once

#include "runtime/render/particle_frame.h"

namespace scree {

// Raw appended data of this machine's byte order; time is left unknown. Throws CaseError naming the file for anything
// else, and for one that is cut off.
ParticleFrame read_vtp(const std::filesystem::path& path);

}  // namespace scree
