#include "runtime/frame_files.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "runtime/result_folder.h"
#include "runtime/results.h"
#include "runtime/run_folder.h"
#include "runtime/timer.h"

namespace scree {

namespace fs = std::filesystem;

namespace {

// The lists are written anew after a frame when this much time went by, and a hundred times what it took the last time.
constexpr std::chrono::duration<double> kSeriesInterval{1.0};  // s
constexpr double kSeriesTimes = 100;

// Each forcing of a file to the disk takes a journal's turn; a checkpoint that knows the frames forces what is left.
constexpr uint64_t kForceBytes = 64 << 20;

}  // namespace

fs::path FrameFiles::path_of(const Frame& frame) const {
  return folder_ / fmt::format("{}_{:012}.vtkhdf", stem_, frame.step);
}

// Nothing is left of a run that went on beyond the frames that its checkpoint knows.
void FrameFiles::prepare() {
  if (std::exchange(prepared_, true)) return;
  written_ = frames_;
  std::error_code error;
  for (const fs::path& path : entries_of(folder_)) {
    const std::string name = path.filename().string();
    if (!name.starts_with(stem_ + "_") || name.find(".vtkhdf") == std::string::npos) continue;
    if (std::ranges::none_of(frames_, [&](const Frame& f) { return path_of(f).filename() == name; }))
      fs::remove(path, error);
  }
  std::erase_if(written_, [&](const Frame& f) { return !fs::exists(path_of(f), error); });  // taken away since
  if (!written_.empty()) write_series();
}

void FrameFiles::write(uint64_t step, double time, Fill fill, std::chrono::milliseconds patience) {
  prepare();
  make_folder(folder_);
  if (!frames_.empty() && frames_.back().step == step) frames_.pop_back();
  const Frame frame = frames_.emplace_back(Frame{step, time});
  settled_ = false;
  try {
    if (behind_.exchange(false)) {
      background_->submit([this] {
        const Timer timer(seconds_);
        catch_up();
      });
    }
    background_->submit([this, frame, fill = std::move(fill)] { write_now(frame, fill); }, patience);
  } catch (...) {  // of an earlier frame; this one will not be there either
    frames_.pop_back();
    throw;
  }
}

void FrameFiles::write_now(const Frame& frame, const Fill& fill) {
  const Timer timer(seconds_);
  const fs::path path = path_of(frame);
  write_vtkhdf(path, type_, [&](VtkHdfFile& file) {
    const int64_t step = static_cast<int64_t>(frame.step);
    file.array("FieldData/time", std::span<const double>(&frame.time, 1));
    file.array("FieldData/step", std::span<const int64_t>(&step, 1));
    fill(file);
  });
  std::error_code error;
  if (const uintmax_t size = fs::file_size(path, error); !error) bytes_ += size;
  unforced_.push_back(path);
  if (!written_.empty() && written_.back().step == frame.step) written_.pop_back();
  written_.push_back(frame);
  if (background_->is_this_thread()) catch_up();
  behind_ = force_due() || series_due();
}

bool FrameFiles::force_due() const { return bytes_ - forced_bytes_ >= kForceBytes; }
bool FrameFiles::series_due() const { return std::chrono::steady_clock::now() >= series_due_at_; }

void FrameFiles::catch_up() {
  if (force_due()) force();
  if (series_due()) write_series();
}

void FrameFiles::force() {
  std::error_code error;
  for (const fs::path& path : unforced_)
    if (fs::exists(path, error) || error) sync_file(path);  // it may have been taken away since
  unforced_.clear();
  forced_bytes_ = bytes_;
}

void FrameFiles::write_series() {
  const auto begun = std::chrono::steady_clock::now();
  nlohmann::json series;
  series["file-series-version"] = "1.0";
  series["files"] = nlohmann::json::array();
  for (const Frame& frame : written_)
    series["files"].push_back({{"name", path_of(frame).filename().string()}, {"time", frame.time}});
  for (const char* ending : {".vtkhdf.series", ".hdf.series"})
    write_file(folder_ / (stem_ + ending), series.dump(1) + "\n");
  const auto now = std::chrono::steady_clock::now();
  series_due_at_ = now + std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                             std::max(kSeriesInterval, kSeriesTimes * std::chrono::duration<double>(now - begun)));
}

void FrameFiles::settle() {
  background_->finish();
  if (settled_) return;
  force();
  if (!written_.empty()) write_series();
  sync_folder(folder_);
  settled_ = true;
}

}  // namespace scree
