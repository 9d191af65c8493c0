#include "runtime/progress.h"

#include <cstdio>

#include <fmt/format.h>

#include "runtime/placement.h"

namespace scree {

std::string duration_text(double s) {
  if (s < 90) return fmt::format("{:.0f} s", s);
  const int minutes = static_cast<int>(s / 60);
  if (s < 5400) return fmt::format("{} min {:02.0f} s", minutes, s - 60 * minutes);
  if (s < 172800) return fmt::format("{} h {:02} min", minutes / 60, minutes % 60);
  return fmt::format("{:.1f} days", s / 86400);
}

void Progress::begin(const std::string& stage) {
  stage_ = stage;
  stage_start_ = Clock::now();
}

bool Progress::is_due(double& since) {
  const auto now = Clock::now();
  since = std::chrono::duration<double>(now - last_).count();
  if (!shown_ || since < 0.5) return false;
  last_ = now;
  return true;
}

void Progress::draw(const std::string& line) {
  fmt::print(stderr, "\r\033[K{:<8} {}", stage_, line);
  std::fflush(stderr);
  drawn_ = true;
}

void Progress::update(double time, size_t particles, double particle_steps, double done) {
  double since = 0;
  if (!is_due(since)) return;
  const double rate = (particle_steps - last_particle_steps_) / since;
  last_particle_steps_ = particle_steps;
  const double elapsed = std::chrono::duration<double>(last_ - stage_start_).count();
  const std::string eta =
      done > 1e-3 ? fmt::format("{:3.0f} %, {} left", 100 * done, duration_text(elapsed * (1 - done) / done)) : "";
  draw(fmt::format("t = {:.4f} s  {} particles  {:.2f} M particle-steps/s  {}", time, particles, rate / 1e6, eta));
}

void Progress::update(const FillProgress& fill) {
  double since = 0;
  if (!is_due(since)) return;
  const std::string apart = fill.sweeps == 0 ? "being placed"
                                             : fmt::format("pushed apart {} times, worst overlap {:.2g} % of a radius",
                                                           fill.sweeps, 100 * fill.worst_overlap);
  draw(fmt::format("region '{}': {} particles, {}", fill.region, fill.particles, apart));
}

void Progress::clear() {
  if (!drawn_) return;
  fmt::print(stderr, "\r\033[K");
  std::fflush(stderr);
  drawn_ = false;
}

}  // namespace scree
