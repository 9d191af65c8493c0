// Puts particles into regions without overlaps: at once (fill) or batch by batch (pour).
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "geometry/closest_point.h"
#include "geometry/solid_index.h"
#include "runtime/engine.h"
#include "runtime/particle_source.h"

namespace scree {

// The inside of a region, and what is in its way.
class FreeSpace {
 public:
  FreeSpace(const Region& region, const Solid& solid);

  // Nearest allowed centre (or nearly): inside the region by `radius`, clear of the solid by `radius`.
  Vec3 confine(const Vec3& x, double radius) const;
  bool allows(const Vec3& x, double radius) const;
  Vec3 random_point(Random& random) const;  // uniform in the region's bounds
  const Bounds& bounds() const { return bounds_; }

  // m3 where a sphere of this radius may have its centre; of radius 0: the region without the solid. By sampling (error
  // about 0.5 %).
  double volume(double radius = 0) const;

 private:
  Vec3 inside_region(const Vec3& x, double radius) const;
  const Region& region_;
  Bounds bounds_;
  std::vector<PreparedPrimitive> prepared_;
  std::unique_ptr<SolidIndex> index_;
};

// How far filling is: in which region, and how its particles are being pushed apart.
struct FillProgress {
  std::string region;
  size_t particles = 0;
  int sweeps = 0;            // 0: they are still being thrown in
  double worst_overlap = 0;  // share of a radius, at the last sweep
};

// A dense random packing: regions in order, each up to the stage's solid fraction of its free space, until mass or
// count is reached. Throws RunError if they do not fit.
// `look` is called now and then, as filling can take minutes: it may throw to give up.
std::vector<ParticleState> fill(
    const Case& c, const FillStage& stage, const Solid& solid, std::span<const ParticleState> present, uint64_t stream,
    const std::function<void(const FillProgress&)>& look = [](const FillProgress&) {});

// One pour: owes what the rate has brought, places what finds room.
class Pour {
 public:
  Pour(const Case& c, const PourStage& stage, const Solid& solid, uint64_t stream);

  // Seconds between batches: a batch is what fills the region to the stage's solid fraction, or what is left.
  double batch_interval() const { return batch_interval_; }
  bool done() const { return stage_.mass > 0 ? mass_ >= stage_.mass : count_ >= stage_.count; }
  double mass() const { return mass_; }

  // Whether what was loaded can be where such a pour is.
  bool is_sound() const;

  // Particles for `elapsed` seconds since the pour began, clear of those present.
  std::vector<ParticleState> batch(double elapsed, std::span<const ParticleState> present);

  // What pouring changes.
  template <class Visit>
  static void for_each_field(const Visit& visit) {
    visit("mass", &Pour::mass_);
    visit("count", &Pour::count_);
    visit("waiting", &Pour::waiting_);
    visit("source", &Pour::source_);
    visit("random", &Pour::random_);
  }

 private:
  PourStage stage_;
  FreeSpace space_;
  ParticleSource source_;
  Random random_;
  double batch_interval_ = 0, mass_ = 0;
  uint64_t count_ = 0;
  std::vector<ParticleState> waiting_;  // drawn, found no room yet
};

}  // namespace scree
