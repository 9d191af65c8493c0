// A results folder belongs to one run at a time.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <vector>

namespace scree {

// The run is refused before it touched anything: the folder is in use, or holds nothing to go on from.
struct RunRefused : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Holds the folder as long as it lives, by a lock on folder/lock that the kernel releases however the process ends.
// The file stays: removing it would open a gap in which two runs lock two files of that name.
class RunFolder {
 public:
  // Makes the folder. Throws RunRefused if another run holds it, RunError if it cannot be made or written.
  explicit RunFolder(const std::filesystem::path& folder);
  ~RunFolder();
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;

 private:
  int descriptor_;
};

// What lies in a folder, sorted by name; nothing where it is not there or cannot be read. (The standard library's own
// walk ends the process where memory runs out on the way.)
std::vector<std::filesystem::path> entries_of(const std::filesystem::path& folder);

// Forces a folder's list of names to the disk, which a rename is only then safe on. Throws RunError.
void sync_folder(const std::filesystem::path& folder);
void sync_file(const std::filesystem::path& file);  // and its content

}  // namespace scree
