// Any bytes are particles with finite numbers in range, or a CaseError; nothing else may happen.
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "runtime/csv_particles.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  try {
    for (const scree::CsvParticle& p :
         scree::read_particles_csv("particles.csv", {reinterpret_cast<const char*>(data), size}))
      if (!(p.radius > 0) || !std::isfinite(scree::norm(p.position)) || !std::isfinite(scree::norm(p.velocity)))
        std::abort();
  } catch (const scree::CaseError&) {
  }
  return 0;
}
