// Files and folders for what a benchmark writes; gone with the object.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <string>

namespace scree::bench {

class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& ending)
      : path_(std::filesystem::temp_directory_path() / ("scree_bench_" + std::to_string(getpid()) + ending)) {}
  ~TemporaryFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

class TemporaryFolder {
 public:
  TemporaryFolder() { std::filesystem::create_directories(file_.path()); }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(file_.path(), ignored);
  }
  const std::filesystem::path& path() const { return file_.path(); }

 private:
  TemporaryFile file_{""};
};

}  // namespace scree::bench
