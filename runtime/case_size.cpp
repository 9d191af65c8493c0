#include "runtime/case_size.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>

namespace scree {
namespace {

using std::numbers::pi;

double sphere_volume(double diameter) { return pi / 6 * diameter * diameter * diameter; }

// Number density of diameters, not normalised.
double number_density(const SizeDistribution& size, double d) {
  if (size.kind == SizeDistribution::Kind::normal)
    return std::exp(-0.5 * std::pow((d - size.mean) / size.deviation, 2));
  return std::exp(-0.5 * std::pow(std::log(d / size.mean) / size.deviation, 2)) / d;
}

double mean_volume_of_list(const SizeDistribution& size) {
  double number = 0, volume = 0;
  for (size_t i = 0; i < size.diameters.size(); ++i) {
    const double v = sphere_volume(size.diameters[i]);
    number += size.fractions_by_mass ? size.fractions[i] / v : size.fractions[i];
    volume += size.fractions_by_mass ? size.fractions[i] : size.fractions[i] * v;
  }
  return volume / number;
}

double count_rows(const std::string& file) {
  std::ifstream stream(file);
  double rows = -1;  // the header
  for (std::string line; std::getline(stream, line);) rows += !line.empty() && line[0] != '#' && line != "\r";
  return std::max(rows, 0.0);
}

double inserted(const Case& c, const Mixture& mixture, double mass, uint64_t count) {
  return count > 0 ? static_cast<double>(count) : mass * particles_per_mass(c, mixture);
}

}  // namespace

double smallest_diameter(const SizeDistribution& size) {
  return size.kind == SizeDistribution::Kind::list ? *std::ranges::min_element(size.diameters) : size.min;
}

double largest_diameter(const SizeDistribution& size) {
  return size.kind == SizeDistribution::Kind::list ? *std::ranges::max_element(size.diameters) : size.max;
}

double mean_particle_volume(const SizeDistribution& size) {
  if (size.kind == SizeDistribution::Kind::list) return mean_volume_of_list(size);
  constexpr int kSteps = 2000;  // midpoint rule: the truncated densities are smooth
  constexpr double kReach =
      8;  // deviations: beyond them nothing is left, and a narrow peak must not fall between steps
  const bool normal = size.kind == SizeDistribution::Kind::normal;
  const double spread = std::exp(kReach * size.deviation);
  const double low = std::max(size.min, normal ? size.mean - kReach * size.deviation : size.mean / spread);
  const double high = std::min(size.max, normal ? size.mean + kReach * size.deviation : size.mean * spread);
  double number = 0, volume = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double d = low + (high - low) * (i + 0.5) / kSteps;
    number += number_density(size, d);
    volume += number_density(size, d) * sphere_volume(d);
  }
  return volume / number;
}

double volume_of(const Region& r) {
  if (r.shape == Region::Shape::box) return (r.max.x - r.min.x) * (r.max.y - r.min.y) * (r.max.z - r.min.z);
  if (r.shape == Region::Shape::cylinder) return pi * r.radius * r.radius * r.height;
  const double dx = r.top_x - r.bottom_x, dy = r.top_y - r.bottom_y;
  return r.height * (r.bottom_x * r.bottom_y + (r.bottom_x * dy + r.bottom_y * dx) / 2 + dx * dy / 3);
}

Bounds bounds_of(const Region& r) {
  if (r.shape == Region::Shape::box) return {r.min, r.max};
  if (r.shape == Region::Shape::cylinder) {
    const Vec3 top = r.base + r.height * r.axis;
    const auto reach = [&](double along) { return r.radius * std::sqrt(std::max(0.0, 1 - along * along)); };
    const Vec3 e{reach(r.axis.x), reach(r.axis.y), reach(r.axis.z)};
    return {Vec3{std::min(r.base.x, top.x), std::min(r.base.y, top.y), std::min(r.base.z, top.z)} - e,
            Vec3{std::max(r.base.x, top.x), std::max(r.base.y, top.y), std::max(r.base.z, top.z)} + e};
  }
  const Vec3 half{std::max(r.bottom_x, r.top_x) / 2, std::max(r.bottom_y, r.top_y) / 2, 0};
  return {r.base - half, r.base + half + Vec3{0, 0, r.height}};
}

double share_between_limits(const SizeDistribution& size) {
  if (size.kind == SizeDistribution::Kind::list) return 1;
  const bool normal = size.kind == SizeDistribution::Kind::normal;
  const auto below = [&](double d) {
    const double deviations = normal ? (d - size.mean) / size.deviation : std::log(d / size.mean) / size.deviation;
    return 0.5 * std::erfc(-deviations / std::numbers::sqrt2);
  };
  return below(size.max) - below(size.min);
}

double particles_per_mass(const Case& c, const Mixture& mixture) {
  double count = 0;
  for (size_t i = 0; i < mixture.kinds.size(); ++i) {
    const ParticleKind& kind = c.kinds[mixture.kinds[i]];
    count += mixture.mass_fractions[i] / (c.materials[kind.material].density * mean_particle_volume(kind.size));
  }
  return count;
}

double expected_particles(const Case& c, const StageAction& action) {
  if (const auto* read = std::get_if<ReadStage>(&action)) return count_rows(read->file);
  if (const auto* pour = std::get_if<PourStage>(&action)) return inserted(c, pour->mixture, pour->mass, pour->count);
  const auto* fill = std::get_if<FillStage>(&action);
  if (!fill) return 0;
  if (fill->mass > 0 || fill->count > 0) return inserted(c, fill->mixture, fill->mass, fill->count);
  double volume = 0, specific_volume = 0;  // m3 of solid per kg
  for (const uint32_t region : fill->regions) volume += volume_of(c.regions[region]);
  for (size_t i = 0; i < fill->mixture.kinds.size(); ++i) {
    specific_volume += fill->mixture.mass_fractions[i] / c.materials[c.kinds[fill->mixture.kinds[i]].material].density;
  }
  return fill->solid_fraction * volume / specific_volume * particles_per_mass(c, fill->mixture);
}

double expected_particles(const Case& c) {
  double sum = 0;
  for (const Stage& stage : c.stages) sum += expected_particles(c, stage.action);
  return sum;
}

double longest_time(const Case& c) {
  double t = 0;
  for (const Stage& stage : c.stages) {
    if (const auto* s = std::get_if<SettleStage>(&stage.action)) t += s->max_time;
    if (const auto* s = std::get_if<DrainStage>(&stage.action)) t += s->max_time;
    if (const auto* s = std::get_if<PourStage>(&stage.action))
      t += (s->mass > 0 ? s->mass : static_cast<double>(s->count) / particles_per_mass(c, s->mixture)) / s->rate;
  }
  return t;
}

}  // namespace scree
