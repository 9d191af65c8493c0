#include "runtime/run_folder.h"

#include <dirent.h>
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>
#include <string_view>

#include <fmt/format.h>

#include "runtime/engine.h"

namespace scree {

namespace {

void sync(const std::filesystem::path& path, int flags) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | flags);
  const bool synced = descriptor >= 0 && (fsync(descriptor) == 0 || errno == EINVAL);  // EINVAL: nothing to force here
  const int why = errno;
  if (descriptor >= 0) ::close(descriptor);
  if (!synced) throw RunError(fmt::format("cannot write {}: {}", path.string(), std::strerror(why)));
}

// The number that the run that holds the lock wrote into it.
std::string holder(int descriptor) {
  char text[32] = {};
  const ssize_t n = pread(descriptor, text, sizeof text - 1, 0);
  return n > 0 ? fmt::format(" (process {})", std::strtol(text, nullptr, 10)) : "";
}

}  // namespace

RunFolder::RunFolder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw RunError(fmt::format("cannot make the results folder {}: {}", folder.string(), error.message()));
  const std::filesystem::path path = folder / "lock";
  descriptor_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor_ < 0) throw RunError(fmt::format("cannot write {}: {}", path.string(), std::strerror(errno)));
  if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
    const int why = errno;
    const std::string who = holder(descriptor_);
    ::close(descriptor_);
    if (why == EWOULDBLOCK)
      throw RunRefused(
          fmt::format("another run{} is using the results folder {}: wait for it, stop it, or name another "
                      "folder with --out",
                      who, folder.string()));
    throw RunError(fmt::format("cannot lock {}: {}", path.string(), std::strerror(why)));
  }
  // For the other's message only, so a failure does no harm.
  const std::string number = fmt::format("{}\n", getpid());
  if (ftruncate(descriptor_, 0) == 0) static_cast<void>(!pwrite(descriptor_, number.data(), number.size(), 0));
}

RunFolder::~RunFolder() { ::close(descriptor_); }

std::vector<std::filesystem::path> entries_of(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> found;
  const std::unique_ptr<DIR, int (*)(DIR*)> open(opendir(folder.c_str()), closedir);
  while (const dirent* entry = open ? readdir(open.get()) : nullptr)
    if (const std::string_view name = entry->d_name; name != "." && name != "..") found.push_back(folder / name);
  std::sort(found.begin(), found.end());
  return found;
}

void sync_folder(const std::filesystem::path& folder) { sync(folder, O_DIRECTORY); }

void sync_file(const std::filesystem::path& file) { sync(file, 0); }

}  // namespace scree
