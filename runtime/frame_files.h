// A time series of VTKHDF files in the results folder, written beside the run:
//
//   FOLDER/STEM_000000012345.vtkhdf   one a frame, by the step; complete under that name
//   FOLDER/STEM.vtkhdf.series         the frames with their times (s): what to open in ParaView; while the run goes on
//                                     a second or two behind, or what a hundred times its writing takes
//   FOLDER/STEM.hdf.series            the same: ParaView 5.11 knows its VTKHDF files by this ending only
#pragma once

#include <atomic>
#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "runtime/background.h"
#include "runtime/state_archive.h"
#include "runtime/vtkhdf_file.h"

namespace scree {

class FrameFiles {
 public:
  using Fill = std::function<void(VtkHdfFile&)>;
  struct Frame {
    uint64_t step = 0;
    double time = 0;  // s
  };

  FrameFiles(const std::filesystem::path& folder, const std::string& stem, VtkHdfType type, Background& background)
      : folder_(folder), stem_(stem), type_(type), background_(&background) {}

  // Submits the writing of this step's frame; one of the same step that is there already is replaced. `patience`:
  // Background::submit()'s. Whoever runs the job forces nothing to the disk; the background thread does, now and then.
  // Throws RunError for this or an earlier frame that could not be written.
  void write(uint64_t step, double time, Fill fill, std::chrono::milliseconds patience = {});

  // Waits until all is written and on the disk. Throws RunError.
  void settle();
  // Removes what a killed run left beyond the frames that were loaded. write() does so before the first.
  void prepare();

  const std::vector<Frame>& frames() const { return frames_; }
  uint64_t bytes() const { return bytes_; }    // written, valid after settle()
  double seconds() const { return seconds_; }  // of the jobs; the same

  void save(StateWriter& out, const std::string& at) const { out.save(at + "/frames", frames_); }
  void load(StateReader& in, const std::string& at) { in.load(at + "/frames", frames_); }

 private:
  std::filesystem::path path_of(const Frame& frame) const;
  void write_now(const Frame& frame, const Fill& fill);
  void force();  // what was written to the disk
  void write_series();
  void catch_up();  // with what is due of these two
  bool force_due() const;
  bool series_due() const;

  std::filesystem::path folder_;
  std::string stem_;
  VtkHdfType type_;
  Background* background_;
  bool prepared_ = false;
  bool settled_ = true;        // the series and the folder are on the disk
  std::vector<Frame> frames_;  // handed over for writing

  // The jobs':
  std::atomic<bool> behind_ = false;  // catch_up() is due; the run asks, too
  std::vector<Frame> written_;
  std::chrono::steady_clock::time_point series_due_at_;  // at once
  std::vector<std::filesystem::path> unforced_;          // written, perhaps not on the disk yet
  uint64_t bytes_ = 0, forced_bytes_ = 0;
  double seconds_ = 0;
};

}  // namespace scree
