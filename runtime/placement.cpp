#include "runtime/placement.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "geometry/bounds.h"
#include "kernels/packing.h"
#include "runtime/case_physics.h"
#include "runtime/case_size.h"

namespace scree {

namespace {

constexpr int kVolumeSamples = 40000;
constexpr int kPackingIterations = 4000;
constexpr int kTries = 200;  // random positions for one poured particle
constexpr double kMostBins = 1e7;

Vec3 clamped(const Vec3& x, const Vec3& low, const Vec3& high) {
  const auto clamp = [](double v, double a, double b) { return a > b ? 0.5 * (a + b) : std::clamp(v, a, b); };
  return {clamp(x.x, low.x, high.x), clamp(x.y, low.y, high.y), clamp(x.z, low.z, high.z)};
}

// Spheres binned over a box, for questions about overlap.
class SphereBins {
 public:
  SphereBins(const Bounds& box, double largest_radius)
      : low_(inflated(box, 2 * largest_radius).min), cell_(2 * largest_radius) {
    const Vec3 size = inflated(box, 2 * largest_radius).max - low_;
    // Wider cells are as right and only slower: few particles in a huge region must not ask for a huge table.
    cell_ = std::max({cell_, std::cbrt(size.x * size.y * size.z / kMostBins), size.x / kMostBins, size.y / kMostBins,
                      size.z / kMostBins});
    for (int a = 0; a < 3; ++a) n_[a] = static_cast<int>((a == 0 ? size.x : a == 1 ? size.y : size.z) / cell_) + 1;
    cells_.resize(size_t(n_[0]) * n_[1] * n_[2]);
  }
  void add(const Vec3& x, double radius) {
    int c[3];
    if (find(x, c)) cells_[at(c[0], c[1], c[2])].push_back({x, radius});
  }
  bool is_free(const Vec3& x, double radius) const {
    int c[3];
    if (!find(x, c)) return false;
    for (int k = std::max(0, c[2] - 1); k <= std::min(n_[2] - 1, c[2] + 1); ++k)
      for (int j = std::max(0, c[1] - 1); j <= std::min(n_[1] - 1, c[1] + 1); ++j)
        for (int i = std::max(0, c[0] - 1); i <= std::min(n_[0] - 1, c[0] + 1); ++i)
          for (const PackedSphere& s : cells_[at(i, j, k)]) {
            const Vec3 d = x - s.position;
            if (dot(d, d) < (radius + s.radius) * (radius + s.radius)) return false;
          }
    return true;
  }

 private:
  size_t at(int i, int j, int k) const { return (size_t(k) * n_[1] + j) * n_[0] + i; }
  bool find(const Vec3& x, int (&c)[3]) const {
    const double offset[3] = {x.x - low_.x, x.y - low_.y, x.z - low_.z};
    for (int a = 0; a < 3; ++a) {
      c[a] = static_cast<int>(std::floor(offset[a] / cell_));
      if (c[a] < 0 || c[a] >= n_[a]) return false;
    }
    return true;
  }
  Vec3 low_;
  double cell_;
  int n_[3];
  std::vector<std::vector<PackedSphere>> cells_;
};

}  // namespace

FreeSpace::FreeSpace(const Region& region, const Solid& solid)
    : region_(region), bounds_(bounds_of(region)), index_(make_embree_index(solid)) {
  for (const Primitive& p : solid.primitives) prepared_.push_back(prepared(p));
}

Vec3 FreeSpace::inside_region(const Vec3& x, double radius) const {
  const Region& r = region_;
  if (r.shape == Region::Shape::box)
    return clamped(x, r.min + Vec3{radius, radius, radius}, r.max - Vec3{radius, radius, radius});
  if (r.shape == Region::Shape::cylinder) {
    const double h = dot(x - r.base, r.axis);
    Vec3 out = (x - r.base) - h * r.axis;
    const double length = norm(out), most = std::max(0.0, r.radius - radius);
    if (length > most) out = (most / length) * out;
    return r.base + out + std::clamp(h, radius, std::max(radius, r.height - radius)) * r.axis;
  }
  // Frustum: the sides lean by (top - bottom) / 2 per height; a sphere keeps its radius from them at a right angle.
  const double z = std::clamp(x.z, r.base.z + radius, std::max(r.base.z + radius, r.base.z + r.height - radius));
  const double t = (z - r.base.z) / r.height;
  const auto half = [&](double bottom, double top) {
    const double lean = 0.5 * (top - bottom) / r.height;
    return std::max(0.0, 0.5 * (bottom + t * (top - bottom)) - radius * std::sqrt(1 + lean * lean));
  };
  const double hx = half(r.bottom_x, r.top_x), hy = half(r.bottom_y, r.top_y);
  return {std::clamp(x.x, r.base.x - hx, r.base.x + hx), std::clamp(x.y, r.base.y - hy, r.base.y + hy), z};
}

Vec3 FreeSpace::confine(const Vec3& x, double radius) const {
  thread_local std::vector<uint32_t> near;
  Vec3 p = inside_region(x, radius);
  for (int round = 0; round < 40; ++round) {
    near.clear();
    index_->query(p, radius, near);
    bool moved = false;
    for (const uint32_t k : near) {
      const Vec3 q = closest_on_skeleton(prepared_[k], p), d = p - q;
      const double away = norm(d), wanted = radius + prepared_[k].radius;
      if (away >= wanted) continue;
      p = q + (wanted * (1 + 1e-9)) * (away > 0 ? (1 / away) * d : Vec3{0, 0, 1});
      moved = true;
    }
    if (!moved) break;
    p = inside_region(p, radius);
  }
  return p;
}

bool FreeSpace::allows(const Vec3& x, double radius) const {
  if (norm(inside_region(x, radius) - x) > 0) return false;
  std::vector<uint32_t> near;
  index_->query(x, radius, near);
  return near.empty();
}

Vec3 FreeSpace::random_point(Random& random) const {
  const Vec3 &a = bounds_.min, &b = bounds_.max;
  const double x = random.uniform(a.x, b.x), y = random.uniform(a.y, b.y), z = random.uniform(a.z, b.z);
  return {x, y, z};
}

double FreeSpace::volume(double radius) const {
  Random random(1, 77);
  int inside = 0;
  for (int k = 0; k < kVolumeSamples; ++k) inside += allows(random_point(random), radius);
  return volume_of(bounds_) * inside / kVolumeSamples;
}

namespace {

// Draws until the region's share or the stage's amount is reached.
std::vector<ParticleState> draw_share(const FillStage& stage, double volume, double mass_left, uint64_t count_left,
                                      ParticleSource& source) {
  std::vector<ParticleState> drawn;
  double sum = 0, mass = 0;
  for (;;) {
    if (stage.mass > 0 && mass >= mass_left) break;
    if (stage.count > 0 && drawn.size() >= count_left) break;
    const ParticleState p = source.draw();
    sum += 4.0 / 3.0 * std::numbers::pi * p.radius * p.radius * p.radius;
    if (sum > volume) break;
    // The last particle may only come in if it brings the mass nearer to what was asked for.
    if (stage.mass > 0 && mass + p.mass - mass_left > mass_left - mass) break;
    mass += p.mass;
    drawn.push_back(p);
  }
  return drawn;
}

// A random allowed point, or nearly: after many tries the nearest that is allowed.
Vec3 random_allowed_point(const FreeSpace& space, double radius, Random& random) {
  Vec3 x;
  for (int tries = 0; tries < kTries; ++tries)
    if (x = space.random_point(random); space.allows(x, radius)) return x;
  return space.confine(x, radius);
}

// One sphere in each of about as many equal cells as there are spheres, anywhere in it. Points drawn without cells have
// dense and loose patches, which take pushing apart thousands of sweeps to even out; these take a hundred.
void place_stratified(std::vector<PackedSphere>& spheres, const FreeSpace& space, Random& random,
                      const std::function<void()>& look) {
  if (spheres.empty()) return;
  double radius = 0;
  for (const PackedSphere& s : spheres) radius += s.radius / static_cast<double>(spheres.size());
  const double cell = std::cbrt(space.volume(radius) / static_cast<double>(spheres.size()));
  if (!(cell > 0)) {  // no sample found room: perhaps there is a little
    for (PackedSphere& s : spheres) s.position = random_allowed_point(space, s.radius, random);
    return;
  }
  const Vec3 size = space.bounds().max - space.bounds().min;
  const auto cells = [&](double length) { return std::max(1, static_cast<int>(std::lround(length / cell))); };
  const int nx = cells(size.x), ny = cells(size.y), nz = cells(size.z);
  std::vector<Vec3> points;
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j) {
      look();
      for (int i = 0; i < nx; ++i)
        for (int tries = 0; tries < 8; ++tries) {
          const double x = random.uniform(), y = random.uniform(), z = random.uniform();
          const Vec3 p = space.bounds().min + Vec3{(i + x) / nx * size.x, (j + y) / ny * size.y, (k + z) / nz * size.z};
          if (!space.allows(p, radius)) continue;
          points.push_back(p);
          break;
        }
    }
  for (size_t k = points.size(); k > 1; --k) std::swap(points[k - 1], points[random.bits() % k]);
  for (size_t k = 0; k < spheres.size(); ++k) {
    if (k % 1024 == 0) look();
    PackedSphere& s = spheres[k];
    s.position = k < points.size() ? space.confine(points[k], s.radius) : random_allowed_point(space, s.radius, random);
  }
}

}  // namespace

std::vector<ParticleState> fill(const Case& c, const FillStage& stage, const Solid& solid,
                                std::span<const ParticleState> present, uint64_t stream,
                                const std::function<void(const FillProgress&)>& look) {
  ParticleSource source(c, stage.mixture, c.seed, stream);
  Random random(c.seed, stream + 1000);
  std::vector<ParticleState> placed;
  std::vector<PackedSphere> fixed;
  for (const ParticleState& p : present) fixed.push_back({p.position, p.radius});
  double mass = 0;
  for (const uint32_t r : stage.regions) {
    const FreeSpace space(c.regions[r], solid);
    std::vector<ParticleState> share = draw_share(stage, stage.solid_fraction * space.volume(), stage.mass - mass,
                                                  stage.count - placed.size(), source);
    std::vector<PackedSphere> spheres(share.size());
    for (size_t k = 0; k < share.size(); ++k) spheres[k].radius = share[k].radius;
    FillProgress progress{c.regions[r].name, share.size()};
    place_stratified(spheres, space, random, [&] { look(progress); });
    const PackingOutcome outcome = push_apart(
        spheres, fixed, [&](const Vec3& x, double radius) { return space.confine(x, radius); }, kPackingIterations,
        [&](const PackingOutcome& so_far) {
          progress.sweeps = so_far.iterations, progress.worst_overlap = so_far.worst_overlap;
          look(progress);
        });
    if (outcome.worst_overlap > 0 || !outcome.confined)
      throw RunError(fmt::format(
          "region '{}' cannot hold {} particles without overlap (solid_fraction {}; after {} iterations the worst "
          "overlap is "
          "{:.3g} of a radius): lower the stage's solid_fraction, or enlarge the region",
          c.regions[r].name, share.size(), stage.solid_fraction, outcome.iterations, outcome.worst_overlap));
    for (size_t k = 0; k < share.size(); ++k) {
      share[k].position = spheres[k].position;
      share[k].velocity = stage.velocity;
      mass += share[k].mass;
      fixed.push_back(spheres[k]);
    }
    placed.insert(placed.end(), share.begin(), share.end());
  }
  const bool short_of_mass =
      stage.mass > 0 && mass < stage.mass - (placed.empty() ? 0 : 2 * placed.back().mass) - 1e-3 * stage.mass;
  if (short_of_mass || placed.size() < stage.count)
    throw RunError(
        fmt::format("the fill stage's regions hold {} particles, {:.6g} kg, at solid_fraction {}; asked for {}: "
                    "enlarge or add regions, or raise solid_fraction (at most 0.6)",
                    placed.size(), mass, stage.solid_fraction,
                    stage.mass > 0 ? fmt::format("{:.6g} kg", stage.mass) : fmt::format("{}", stage.count)));
  return placed;
}

Pour::Pour(const Case& c, const PourStage& stage, const Solid& solid, uint64_t stream)
    : stage_(stage),
      space_(c.regions[stage.region], solid),
      source_(c, stage.mixture, c.seed, stream),
      random_(c.seed, stream + 1000) {
  const double per_kg = particles_per_mass(c, stage.mixture);
  double mean_volume = 0;
  for (size_t k = 0; k < stage.mixture.kinds.size(); ++k)
    mean_volume += stage.mixture.mass_fractions[k] / c.materials[c.kinds[stage.mixture.kinds[k]].material].density;
  const double batch_mass = std::max(stage.solid_fraction * space_.volume() / mean_volume, 1 / per_kg);
  batch_interval_ = batch_mass / stage.rate;
}

bool Pour::is_sound() const {
  const auto drawable = [&](const ParticleState& p) {
    return std::ranges::count(stage_.mixture.kinds, p.kind) > 0 && std::isfinite(p.radius) && p.radius > 0 &&
           std::isfinite(p.mass) && p.mass > 0;
  };
  return std::isfinite(mass_) && mass_ >= 0 && source_.is_sound() && std::ranges::all_of(waiting_, drawable);
}

std::vector<ParticleState> Pour::batch(double elapsed, std::span<const ParticleState> present) {
  const double target = stage_.rate * (elapsed + batch_interval_);
  double largest = 0, coming = mass_;
  for (const ParticleState& p : waiting_) coming += p.mass;
  const auto enough = [&] {
    return stage_.mass > 0 ? coming >= stage_.mass * (1 - 1e-9) : count_ + waiting_.size() >= stage_.count;
  };
  while (coming < target && !enough()) {
    waiting_.push_back(source_.draw());
    coming += waiting_.back().mass;
  }
  for (const ParticleState& p : waiting_) largest = std::max(largest, p.radius);
  for (const ParticleState& p : present) largest = std::max(largest, p.radius);
  SphereBins bins(space_.bounds(), largest);
  for (const ParticleState& p : present) bins.add(p.position, p.radius);

  std::vector<ParticleState> placed, left;
  for (ParticleState& p : waiting_) {
    bool found = false;
    for (int attempt = 0; attempt < kTries && !found; ++attempt) {
      p.position = space_.random_point(random_);
      found = space_.allows(p.position, p.radius) && bins.is_free(p.position, p.radius);
    }
    if (!found) {
      left.push_back(p);
      continue;
    }
    p.velocity = stage_.velocity;
    bins.add(p.position, p.radius);
    placed.push_back(p);
    mass_ += p.mass, ++count_;
  }
  waiting_ = std::move(left);
  if (stage_.mass > 0 && waiting_.empty() && enough()) mass_ = std::max(mass_, stage_.mass);
  return placed;
}

}  // namespace scree
