#include "runtime/result_folder.h"

#include <system_error>

#include <fmt/format.h>

#include "runtime/engine.h"

namespace scree {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail(const fs::path& path, const std::string& why) {
  throw RunError(fmt::format("cannot write {}: {}", path.string(), why));
}

}  // namespace

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) fail(folder, error.message());
}

void write_vtkhdf(const fs::path& path, VtkHdfType type, const std::function<void(VtkHdfFile&)>& fill) {
  const fs::path part = path.string() + ".part";
  try {
    VtkHdfFile file(part, type);
    fill(file);
    file.close();
    fs::rename(part, path);
  } catch (const Hdf5Error& e) {
    std::error_code ignored;
    fs::remove(part, ignored);
    fail(path, e.what());
  } catch (const fs::filesystem_error& e) {
    fail(path, e.code().message());
  }
}

}  // namespace scree
