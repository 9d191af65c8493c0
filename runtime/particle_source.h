// Draws particles of a mixture: kind by mass fraction, diameter from the kind's size distribution.
#pragma once

#include "runtime/case.h"
#include "runtime/engine.h"
#include "runtime/random.h"

namespace scree {

class ParticleSource {
 public:
  ParticleSource(const Case& c, const Mixture& mixture, uint64_t seed, uint64_t stream);

  // Kind, radius and mass are set; the rest is zero. The mass drawn per kind follows the mixture at every moment: the
  // kind furthest behind its share comes next.
  ParticleState draw();

  // Whether what was loaded fits the mixture.
  bool is_sound() const { return drawn_mass_.size() == mixture_.kinds.size(); }

  // What drawing changes.
  template <class Visit>
  static void for_each_field(const Visit& visit) {
    visit("drawn_mass", &ParticleSource::drawn_mass_);
    visit("random", &ParticleSource::random_);
  }

 private:
  double draw_diameter(const SizeDistribution& size);

  const Case& case_;
  Mixture mixture_;
  std::vector<double> drawn_mass_;
  std::vector<std::vector<double>> cumulative_;  // per kind in the mixture: number fractions of a list, summed up
  Random random_;
};

}  // namespace scree
