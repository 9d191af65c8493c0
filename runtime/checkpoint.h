// The checkpoints of a run: DIR/checkpoints/step_000012345.h5, each one HDF5 file with the whole state, sealed
// (runtime/seal.h) and put in place by a rename, so that a file of that name is complete whatever happens meanwhile.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "runtime/case.h"
#include "runtime/engine.h"
#include "runtime/state_archive.h"

namespace scree {

// A checkpoint could not be written. The run stops: going on without one is not what was asked for.
struct CheckpointError : RunError {
  using RunError::RunError;
};

// Why a checkpoint is not gone on from, without its name.
struct CheckpointRefused : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// What a checkpoint says of the case that it belongs to.
struct CheckpointHead {
  std::string case_text;  // Case::understood
  uint64_t solid = 0;     // checksum of the fibres and walls, which files and generators beside the text shape too
  std::string failure;    // what failed the run in this very state; empty: the state is good
  template <class Visit>
  static void for_each_field(const Visit& visit) {
    visit("case", &CheckpointHead::case_text);
    visit("solid_checksum", &CheckpointHead::solid);
    visit("failure", &CheckpointHead::failure);
  }
};
CheckpointHead head_of(const Case& c, const std::string& failure = "");

// Throws CheckpointRefused if a state with this head must not be gone on from with this case.
void check_head(const CheckpointHead& head, const Case& c);

class Checkpoints {
 public:
  using Save = std::function<void(StateWriter&)>;
  using Load = std::function<void(StateReader&)>;
  struct Written {
    std::string name;
    uint64_t bytes = 0;
    double seconds = 0;
  };

  // `keep`: how many good ones stay.
  Checkpoints(const std::filesystem::path& results, uint64_t keep) : folder_(results / "checkpoints"), keep_(keep) {}

  // Writes one, forces it to the disk, and only then removes the oldest. Throws CheckpointError.
  Written write(uint64_t step, const Save& save) const;
  // A state that failed, to be looked at, not gone on from: failed_step_000012345.h5. Only the newest stays.
  Written write_failed(uint64_t step, const Save& save) const;
  // All of those, or all but one.
  void remove_failed(const std::string& but = {}) const;

  // The good ones (as far as their names say), newest first.
  std::vector<std::filesystem::path> newest_first() const;

  // Verifies the seal, then loads. Throws CheckpointRefused.
  static void read(const std::filesystem::path& path, const Load& load);

  // Before a run goes on from `used`: newer ones, which were refused, get names that no run takes up, and what a killed
  // writer left is removed.
  void set_aside_newer(const std::filesystem::path& used) const;

 private:
  Written put(const std::string& name, const Save& save) const;
  std::filesystem::path folder_;
  uint64_t keep_;
};

}  // namespace scree
