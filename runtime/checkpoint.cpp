#include "runtime/checkpoint.h"

#include <algorithm>
#include <optional>
#include <system_error>

#include <fmt/format.h>

#include "runtime/case_difference.h"
#include "runtime/case_error.h"
#include "runtime/checksum.h"
#include "runtime/run_folder.h"
#include "runtime/seal.h"
#include "runtime/timer.h"

namespace scree {

namespace fs = std::filesystem;

namespace {

uint64_t checksum_of(const Solid& solid) {
  Checksum sum;
  const auto add = [&](const auto& value) { sum.add(&value, sizeof value); };
  for (const Primitive& p : solid.primitives) {
    std::visit(add, p.skeleton);
    add(p.skeleton.index()), add(p.radius), add(p.material), add(p.wall), add(p.velocity);
  }
  return sum.value();
}

std::vector<fs::path> files_named(const fs::path& folder, const std::string& begin, const std::string& end) {
  std::vector<fs::path> found;
  for (const fs::path& path : entries_of(folder)) {
    const std::string name = path.filename().string();
    if (name.starts_with(begin) && name.ends_with(end)) found.push_back(path);
  }
  std::ranges::reverse(found);  // the newest first
  return found;
}

// The texts may differ in comments and order; a text that is not even a case has another origin.
void check_case_text(const std::string& before, const std::string& now) {
  std::optional<std::string> difference;
  try {
    difference = case_difference(before, now);
  } catch (const CaseError& e) {
    throw CheckpointRefused(fmt::format("its case cannot be read: {}", e.what()));
  }
  if (difference) throw CheckpointRefused("it belongs to another case: " + *difference);
}

std::string step_name(uint64_t step) { return fmt::format("step_{:012}.h5", step); }

}  // namespace

CheckpointHead head_of(const Case& c, const std::string& failure) {
  return {c.understood, checksum_of(c.solid), failure};
}

void check_head(const CheckpointHead& head, const Case& c) {
  if (!head.failure.empty()) throw CheckpointRefused("it holds the state that failed: " + head.failure);
  if (head.case_text != c.understood) check_case_text(head.case_text, c.understood);
  if (head.solid != checksum_of(c.solid))
    throw CheckpointRefused("its fibres or walls are others: a file that the case names, or the program, has changed");
}

Checkpoints::Written Checkpoints::put(const std::string& name, const Save& save) const {
  Written written{name, 0, 0};
  const fs::path path = folder_ / name, part = path.string() + ".part";
  const auto fail = [&](const std::string& why) {
    std::error_code ignored;
    fs::remove(part, ignored);
    throw CheckpointError(fmt::format("cannot write the checkpoint {}: {}", path.string(), why));
  };
  try {
    Timer t(written.seconds);
    if (fs::create_directories(folder_)) sync_folder(folder_.parent_path());
    Hdf5Writer file(part);
    StateWriter writer(file);
    save(writer);
    seal(part, file.close());
    fs::rename(part, path);
    sync_folder(folder_);
    written.bytes = fs::file_size(path);
  } catch (const Hdf5Error& e) {
    fail(e.what());
  } catch (const fs::filesystem_error& e) {
    fail(e.code().message());
  } catch (const std::system_error& e) {
    fail(e.code().message());
  } catch (const RunError& e) {
    fail(e.what());
  } catch (const std::bad_alloc&) {
    fail("no memory is left for writing it");
  }
  return written;
}

Checkpoints::Written Checkpoints::write(uint64_t step, const Save& save) const {
  const Written written = put(step_name(step), save);
  std::vector<fs::path> all = newest_first();
  std::error_code ignored;  // one too many does no harm
  for (size_t k = keep_; k < all.size(); ++k)
    if (all[k].filename() != written.name) fs::remove(all[k], ignored);
  return written;
}

Checkpoints::Written Checkpoints::write_failed(uint64_t step, const Save& save) const {
  const Written written = put("failed_" + step_name(step), save);
  remove_failed(written.name);
  return written;
}

void Checkpoints::remove_failed(const std::string& but) const {
  std::error_code ignored;  // one too many does no harm
  for (const fs::path& old : files_named(folder_, "failed_", ".h5"))
    if (old.filename() != but) fs::remove(old, ignored);
}

std::vector<fs::path> Checkpoints::newest_first() const { return files_named(folder_, "step_", ".h5"); }

void Checkpoints::read(const fs::path& path, const Load& load) {
  try {
    verify_seal(path);
    Hdf5Reader file(path);
    StateReader reader(file);
    load(reader);
  } catch (const SealBroken& e) {
    throw CheckpointRefused(e.what());
  } catch (const Hdf5Error& e) {
    throw CheckpointRefused(e.what());
  } catch (const StateRefused& e) {
    throw CheckpointRefused(fmt::format("its values are no state of this case: {}", e.what()));
  } catch (const std::system_error& e) {
    throw CheckpointRefused("cannot be read: " + e.code().message());
  }
}

void Checkpoints::set_aside_newer(const fs::path& used) const {
  for (const fs::path& newer : newest_first()) {
    if (newer <= used) break;
    fs::rename(newer, newer.string() + ".refused");
  }
  for (const fs::path& part : files_named(folder_, "", ".part")) fs::remove(part);
}

}  // namespace scree
