#include "runtime/particle_source.h"

#include "runtime/case_physics.h"

namespace scree {

namespace {

// Number fractions of a list: mass fractions divided by d^3.
std::vector<double> cumulative_numbers(const SizeDistribution& size) {
  std::vector<double> sum;
  double total = 0;
  for (size_t k = 0; k < size.diameters.size(); ++k) {
    const double d = size.diameters[k];
    total += size.fractions_by_mass ? size.fractions[k] / (d * d * d) : size.fractions[k];
    sum.push_back(total);
  }
  for (double& s : sum) s /= total;
  return sum;
}

}  // namespace

ParticleSource::ParticleSource(const Case& c, const Mixture& mixture, uint64_t seed, uint64_t stream)
    : case_(c), mixture_(mixture), drawn_mass_(mixture.kinds.size(), 0.0), random_(seed, stream) {
  for (uint32_t kind : mixture.kinds) {
    const SizeDistribution& size = c.kinds[kind].size;
    cumulative_.push_back(size.kind == SizeDistribution::Kind::list ? cumulative_numbers(size) : std::vector<double>{});
  }
}

double ParticleSource::draw_diameter(const SizeDistribution& size) {
  for (;;) {
    const double z = random_.normal();
    const double d = size.kind == SizeDistribution::Kind::normal ? size.mean + size.deviation * z
                                                                 : size.mean * std::exp(size.deviation * z);
    if (d >= size.min && d <= size.max) return d;
  }
}

ParticleState ParticleSource::draw() {
  size_t next = 0;
  for (size_t k = 1; k < mixture_.kinds.size(); ++k)
    if (drawn_mass_[k] * mixture_.mass_fractions[next] < drawn_mass_[next] * mixture_.mass_fractions[k]) next = k;
  const ParticleKind& kind = case_.kinds[mixture_.kinds[next]];
  double diameter = 0;
  if (kind.size.kind == SizeDistribution::Kind::list) {
    const double u = random_.uniform();
    size_t k = 0;
    while (k + 1 < cumulative_[next].size() && u >= cumulative_[next][k]) ++k;
    diameter = kind.size.diameters[k];
  } else {
    diameter = draw_diameter(kind.size);
  }
  ParticleState p;
  p.kind = mixture_.kinds[next];
  p.radius = 0.5 * diameter;
  p.mass = sphere_mass(p.radius, case_.materials[kind.material].density);
  drawn_mass_[next] += p.mass;
  return p;
}

}  // namespace scree
