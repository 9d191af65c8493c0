// Any bytes are fibres with two finite ends apart and a diameter in range, or a CaseError; nothing else may happen.
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "runtime/csv_fibres.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  try {
    for (const scree::Fibre& f : scree::read_fibres_csv("fibres.csv", {reinterpret_cast<const char*>(data), size})) {
      const double length = scree::norm(f.axis.b - f.axis.a);
      if (!(length >= scree::kShortestFibre) || !std::isfinite(length)) std::abort();
      if (f.diameter != 0 && !scree::holds(scree::kFibreDiameter, f.diameter)) std::abort();
    }
  } catch (const scree::CaseError&) {
  }
  return 0;
}
