// Any bytes are a case or a CaseError; nothing else may happen. A case that was read can be described, its solid
// searched, and what was understood of it reads back as the same case.
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "geometry/solid_index.h"
#include "runtime/case_difference.h"
#include "runtime/case_reader.h"
#include "runtime/memory.h"
#include "runtime/simulation.h"
#include "runtime/time_scales.h"

namespace {

constexpr size_t kFewPrimitives = 200;  // a search structure over more is slow and shows nothing more

// Files that a case may name: bases, fibres and particles as CSV.
const std::string kPath = std::string(SCREE_FUZZ_FILES) + "/case.toml";

void use(const scree::Case& c) {
  if (scree::describe_case(c).empty() || !(scree::memory_needed(c) > 0)) std::abort();
  scree::time_step_warnings(c);
  if (c.solid.primitives.size() > kFewPrimitives) return;
  std::vector<uint32_t> found;
  scree::make_brute_force_index(c.solid)->query({0, 0, 0}, 1e-3, found);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  scree::Case c;
  try {
    c = scree::read_case_text({reinterpret_cast<const char*>(data), size}, kPath);
  } catch (const scree::CaseError&) {
    return 0;
  }
  use(c);
  const scree::Case again = scree::read_case_text(c.understood, kPath);  // a CaseError ends it, too
  if (const auto difference = scree::case_difference(c.understood, again.understood)) {
    std::fprintf(stderr, "read back, it is another case: %s\n", difference->c_str());
    std::abort();
  }
  return 0;
}
