// One line on the terminal that says how far a run is.
#pragma once

#include <chrono>
#include <string>

namespace scree {

struct FillProgress;

class Progress {
 public:
  explicit Progress(bool shown) : shown_(shown) {}
  ~Progress() { clear(); }

  // A new stage begins: its share of done work counts from here.
  void begin(const std::string& stage);
  // At most a few lines a second. `done` is the stage's share, 0..1 (negative: not known).
  void update(double time, size_t particles, double particle_steps, double done);
  void update(const FillProgress& fill);
  void clear();

 private:
  bool is_due(double& since);  // since the last line, s
  void draw(const std::string& line);

  using Clock = std::chrono::steady_clock;
  bool shown_, drawn_ = false;
  std::string stage_;
  Clock::time_point stage_start_ = Clock::now(), last_ = Clock::now();
  double last_particle_steps_ = 0;
};

std::string duration_text(double seconds);  // "42 s", "3 min 10 s", "2 h 05 min", "3.4 days"

}  // namespace scree
