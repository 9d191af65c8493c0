// Stable parallel sort of (code, index) pairs packed as code << 32 | index, by the code's low `bits` bits.
#pragma once

#include <cstdint>
#include <vector>

namespace scree {

// `scratch` is resized to the size of `packed`. The result is the one stable order, whatever the number of threads.
void radix_sort(std::vector<uint64_t>& packed, std::vector<uint64_t>& scratch, int bits);

}  // namespace scree
