// A seal on a finished file: its first kHeaderBytes say what the rest must be, down to the last bit. A file is verified
// before any library parses it, so damage of any kind ends in a reason, not in a crash.
//
//     | header: format, size, checksums | ... gap ... | large array | ... gap ... | large array | ...
//
// Large arrays are checked by sums that were taken while they were written; all between them was read back for sealing.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <vector>

#include "runtime/hdf5_file.h"

namespace scree {

// Why a file is not to be used, without its name: "truncated: ...".
struct SealBroken : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Raise when the content of a checkpoint changes its meaning or a record its layout.
inline constexpr uint32_t kCheckpointFormat = 5;

// Seals the file and forces it to the disk. Throws std::system_error.
void seal(const std::filesystem::path& path, std::vector<Extent> extents);

// Returns if every byte is as sealed, throws SealBroken if not.
void verify_seal(const std::filesystem::path& path);

}  // namespace scree
