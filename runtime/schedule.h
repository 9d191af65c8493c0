// When something is looked at while a run goes on.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace scree {

// As the case says it. Times in s since the run began.
struct Moments {
  double interval = 0;                                            // 0: none at intervals
  std::vector<double> times = {};                                 // single moments, ascending
  bool stage_ends = false;                                        // at the end of every stage, too
  double from = 0, to = std::numeric_limits<double>::infinity();  // intervals count within
};

// The same in steps, counted from the run's beginning: a run that was resumed goes on with the same moments.
class Schedule {
 public:
  static constexpr uint64_t kNever = ~uint64_t{0};

  Schedule() = default;
  Schedule(const Moments& moments, double dt) : stage_ends_(moments.stage_ends) {
    const auto step_at = [dt](double time) { return static_cast<uint64_t>(std::llround(std::min(time / dt, 9e18))); };
    if (moments.interval > 0) every_ = std::max<uint64_t>(1, step_at(moments.interval));
    from_ = step_at(moments.from), to_ = step_at(moments.to);
    for (double time : moments.times) singles_.push_back(step_at(time));
  }

  bool stage_ends() const { return stage_ends_; }

  // The first due step after `step`; kNever: none.
  uint64_t after(uint64_t step) const {
    uint64_t next = kNever;
    if (every_ != kNever) {
      const uint64_t k = step < from_ ? 0 : (step - from_) / every_ + 1;
      const uint64_t due = from_ + k * every_;
      if (due <= to_) next = due;
    }
    for (uint64_t single : singles_)
      if (single > step) next = std::min(next, single);
    return next;
  }

 private:
  uint64_t every_ = kNever, from_ = 0, to_ = kNever;
  std::vector<uint64_t> singles_;
  bool stage_ends_ = false;
};

}  // namespace scree
