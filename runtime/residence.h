// How long grains stay in a layer (a lattice's cells, between two heights), and where they are left in it.
//
//   DIR/residence.csv   from_s, to_s, mass_kg: the mass of those that went through, by the time that it took
//   DIR/retained.csv    x_m, y_m, z_m, mass_kg, grains, near_kg, near_grains, along_fibres_kg, along_fibres_grains:
//                       what is left in the layer at the run's end, by the nearest junction of fibres within half a
//                       cell's edge. Each grain thus has a junction, also on the middle of a fibre; near it is what
//                       is nearer to it than to the middle of a fibre (a quarter of the median axis). The rest lies
//                       along the fibres, or is on its way where the run ends while grains fall.
//   DIR/residence/      both as pictures (runtime/residence_pictures.h)
//
// A grain enters when its centre is first below the layer's top and is out when it is first below its bottom (or has
// left the run). Only what enters after the first drain stage began is counted as going through: what was filled into
// the layer, or sank into it while it was closed, has not. Without a drain stage all that enters counts. Looks come at
// an interval, which is the resolution: crossings between two are placed by the straight line.
#pragma once

#include "runtime/observer.h"

namespace scree {

inline constexpr double kResidenceBytesPerParticle = 20;

// Masses by the time that they took.
struct ResidenceTimes {
  std::vector<std::pair<double, double>> taken;  // s, kg; ascending
  double mass() const;
  double mean() const;                  // s, by mass
  double quantile(double share) const;  // s: this share of the mass took no longer
};

struct ResidenceBin {
  double from = 0, to = 0;  // s
  double mass = 0;          // kg
};
// Bins from 0 on, as wide as `width`; 0: 1, 2 or 5 times a power of ten, at least `finest`, about 50 of them.
std::vector<ResidenceBin> bins_of(const ResidenceTimes& times, double width, double finest);

// What is left at a junction.
struct Retained {
  Vec3 at{};
  double mass = 0;  // kg
  double grains = 0;
  double near_mass = 0, near_grains = 0;  // of these, near it
  double mass_along_fibres() const { return mass - near_mass; }
  double grains_along_fibres() const { return grains - near_grains; }
};

class Residence final : public Observer {
 public:
  Residence(const Case& c, double dt);

  std::string name() const override { return "residence"; }
  const Schedule& schedule() const override { return schedule_; }
  void look(const RunView& run) override;
  void finish(const RunView& run) override;
  void save(StateWriter& out, const std::string& at) const override;
  void load(StateReader& in, const std::string& at) override;
  nlohmann::json summary() const override { return summary_; }

  ResidenceTimes times() const;

 private:
  // What is known of a grain, by its id. Times in s since the run began; heights in m.
  struct Track {
    float height = 0;  // at the last look
    float entry = kNot, exit = kNot;
    float mass = 0;     // kg
    uint32_t look = 0;  // number of the last look that saw it; 0: none
    bool went_through() const { return entry >= 0 && exit >= 0; }
  };
  static constexpr float kNot = -1;     // has not happened
  static constexpr float kBefore = -2;  // had happened before it counted

  void see(Track& track, const ParticleState& p, double time);
  float crossing(const Track& track, double height, double plane, double time) const;
  bool counts(const RunView& run) const;
  std::vector<Retained> find_retained(const RunView& run);  // puts the sums into the summary

  ResidenceSettings settings_;
  Schedule schedule_;
  bool waits_for_drain_ = false;
  uint32_t looks_ = 0;
  double last_look_ = 0;  // s
  bool counting_ = false;
  std::vector<Track> tracks_;
  double seconds_ = 0;  // wall-clock, of all looks
  nlohmann::json summary_;
};

}  // namespace scree
