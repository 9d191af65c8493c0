#include <algorithm>
#include <chrono>

#include <fmt/format.h>

#include "kernels/parallel.h"
#include "runtime/case_physics.h"
#include "runtime/case_size.h"
#include "runtime/memory.h"
#include "runtime/placement.h"
#include "runtime/progress.h"
#include "runtime/simulation.h"
#include "runtime/time_scales.h"

namespace scree {

namespace {

std::string stage_text(const Case& c, const Stage& stage) {
  struct Text {
    const Case& c;
    std::string operator()(const FillStage& s) const {
      return fmt::format("fill: {:.0f} particles at solid fraction {}", expected_particles(c, s), s.solid_fraction);
    }
    std::string operator()(const PourStage& s) const {
      return fmt::format("pour: {:.0f} particles at {:.4g} kg/s from '{}'", expected_particles(c, s), s.rate,
                         c.regions[s.region].name);
    }
    std::string operator()(const ReadStage& s) const {
      return fmt::format("read: {:.0f} particles from {}", expected_particles(c, s), s.file);
    }
    std::string operator()(const SettleStage& s) const {
      return s.kinetic_energy_per_particle > 0 ? fmt::format("settle: until {:.3g} J a particle, at most {:.4g} s",
                                                             s.kinetic_energy_per_particle, s.max_time)
                                               : fmt::format("settle: {:.4g} s", s.max_time);
    }
    std::string operator()(const OpenStage& s) const { return fmt::format("open: {}", fmt::join(s.walls, ", ")); }
    std::string operator()(const DrainStage& s) const {
      std::vector<std::string> ends;
      if (s.discharged_fraction > 0) ends.push_back(fmt::format("{:.4g} % is out", 100 * s.discharged_fraction));
      if (s.max_time > 0) ends.push_back(fmt::format("{:.4g} s", s.max_time));
      if (s.no_flow_time > 0) ends.push_back(fmt::format("nothing has left for {:.4g} s", s.no_flow_time));
      return fmt::format("drain: until {}", fmt::join(ends, " or "));
    }
  };
  const std::string text = std::visit(Text{c}, stage.action);
  return stage.name.empty() || text.starts_with(stage.name) ? text : stage.name + " - " + text;
}

}  // namespace

// Particle-steps per second on this machine, now: a short run of a small dense bed of the case's first kind.
double measured_rate(const Case& c) {
  Case bed;
  bed.materials = c.materials, bed.pairs = c.pairs, bed.contact = c.contact;
  bed.kinds = {c.kinds.front()};
  bed.time = c.time;
  bed.time.step = time_step_of(c);
  const double d = 2 * largest_radius(c), side = 30 * d;
  bed.domain = {{0, 0, 0}, {side, side, side}};
  for (bool& p : bed.periodic) p = true;
  bed.gravity = {0, 0, 0};
  auto engine = make_engine(bed);
  ParticleSource source(bed, {{0}, {1.0}}, 1, 1);
  Random random(1, 2);
  std::vector<ParticleState> particles;
  for (int k = 0; k < 27000; ++k) {
    ParticleState p = source.draw();
    const auto at = [&](int i) { return (i + 0.5) * d + random.uniform(-0.02, 0.02) * d; };
    p.position = {at(k % 30), at(k / 30 % 30), at(k / 900)};
    particles.push_back(p);
  }
  engine->insert(particles);
  for (int k = 0; k < 20; ++k) engine->step();
  const auto start = std::chrono::steady_clock::now();
  const uint64_t before = engine->counters().particle_steps;
  double seconds = 0;
  while (seconds < 0.4) {
    engine->step();
    seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  return static_cast<double>(engine->counters().particle_steps - before) / seconds;
}

constexpr double kBytesInFrame = 60;  // of a particle, compressed, with all fields: measured on the demo

// Of particles in DIR/fields.
double most_frames(const Case& c) {
  const Moments& m = c.output.fields.moments;
  double frames = static_cast<double>(m.times.size());
  if (m.stage_ends) frames += static_cast<double>(c.stages.size());
  if (m.interval > 0) frames += std::floor(std::max(0.0, std::min(longest_time(c), m.to) - m.from) / m.interval);
  return frames;
}

std::string describe_case(const Case& c) {
  const TimeScales s = time_scales(c);
  const double particles = expected_particles(c);
  std::string text = fmt::format("{}\n", c.title);
  const auto line = [&](std::string_view name, const std::string& value) {
    text += fmt::format("  {:<16} {}\n", name, value);
  };
  line("particles", fmt::format("{:.0f}, radius {:.4g} to {:.4g} m, {} kind{}", particles, smallest_radius(c),
                                largest_radius(c), c.kinds.size(), c.kinds.size() == 1 ? "" : "s"));
  if (c.fibres.count > 0)
    line("fibres", fmt::format("{}, diameter {:.4g} m, porosity {:.4f} (of the union)", c.fibres.count,
                               c.fibres.diameter, c.fibres.porosity));
  line("walls", fmt::format("{} of {} surfaces: {}", c.solid.walls.size(), c.solid.primitives.size() - c.fibres.count,
                            fmt::join(c.solid.walls, ", ")));
  line("time step",
       fmt::format("{:.4g} s = {:.3f} of the Rayleigh time {:.4g} s = {:.3f} of the Hertz time {:.4g} s at {:.3g} m/s",
                   s.step, s.step / s.rayleigh, s.rayleigh, s.step / s.hertz, s.hertz, s.speed));
  for (size_t k = 0; k < c.stages.size(); ++k)
    line(k == 0 ? "stages" : "", fmt::format("{}. {}", k + 1, stage_text(c, c.stages[k])));
  if (const double t = longest_time(c); t > 0)
    line("physical time", fmt::format("at most {:.4g} s = {:.0f} steps", t, t / s.step));
  if (const double frames = most_frames(c); frames > 0)
    line("field files",
         fmt::format("at most {:.0f} frames of about {}", frames, bytes_text(kBytesInFrame * particles)));
  const AvailableMemory available = available_memory();
  line("memory", fmt::format("about {}, of {} available", bytes_text(memory_needed(c)), bytes_text(available.bytes)));
  return text;
}

std::string estimate_time(const Case& c) {
  const double rate = measured_rate(c), steps = longest_time(c) / time_step_of(c), particles = expected_particles(c);
  return fmt::format(
      "  {:<16} at most about {} with {} thread{} ({:.3g} M particle-steps/s measured now on a small bed)\n",
      "wall time", duration_text(particles * steps / rate), thread_count(), thread_count() == 1 ? "" : "s", rate / 1e6);
}

}  // namespace scree
