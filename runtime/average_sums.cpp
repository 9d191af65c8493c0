#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/bounds.h"
#include "geometry/closest_point.h"
#include "kernels/parallel.h"
#include "runtime/averages.h"

namespace scree {

namespace {

constexpr size_t kGrainsAtOnce = 1 << 18;  // 120 B each
constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

using GrainSample = CoarseSample<kGrainValues>;
using StressSample = CoarseSample<kStressValues>;

// Where a grain's values are: kGrainValues of them.
enum GrainValue { kMass, kVolume, kCount, kMomentum, kFlow = kMomentum + 3 };  // kFlow: xx, yy, zz, xy, yz, xz

GrainSample sample_of(const ParticleState& p) {
  const Vec3& v = p.velocity;
  const double m = p.mass, volume = 4.0 / 3 * M_PI * p.radius * p.radius * p.radius;
  return {p.position,
          {m, volume, 1, m * v.x, m * v.y, m * v.z, m * v.x * v.x, m * v.y * v.y, m * v.z * v.z, m * v.x * v.y,
           m * v.y * v.z, m * v.x * v.z}};
}

// The force on a particle at the end of the branch from the contact's point to its centre.
StressSample sample_of(const Vec3& point, const Vec3& branch, const Vec3& f) {
  const Vec3& l = branch;
  return {point + 0.5 * l,
          {f.x * l.x, f.y * l.y, f.z * l.z, 0.5 * (f.x * l.y + f.y * l.x), 0.5 * (f.y * l.z + f.z * l.y),
           0.5 * (f.x * l.z + f.z * l.x)}};
}

std::vector<StressSample> stress_samples(std::span<const ContactState> contacts, std::span<const double> radii) {
  std::vector<StressSample> samples;
  samples.reserve(2 * contacts.size());
  for (const ContactState& k : contacts) {
    const double inside = k.with_solid ? k.overlap : 0.5 * k.overlap;  // how deep the point lies in the particle
    samples.push_back(sample_of(k.point, (radii[k.i] - inside) * k.normal, k.force));
    if (!k.with_solid) samples.push_back(sample_of(k.point, -(radii[k.j] - inside) * k.normal, -k.force));
  }
  return samples;
}

// A periodic pair's samples may lie a little outside the domain.
void wrap_into(const Case& c, std::vector<StressSample>& samples) {
  const Vec3 size = c.domain.max - c.domain.min;
  const auto wrap = [](double& x, double low, double length) { x -= length * std::floor((x - low) / length); };
  for (StressSample& s : samples) {
    if (c.periodic[0]) wrap(s.x.x, c.domain.min.x, size.x);
    if (c.periodic[1]) wrap(s.x.y, c.domain.min.y, size.y);
    if (c.periodic[2]) wrap(s.x.z, c.domain.min.z, size.z);
  }
}

// ---- what follows from the sums

// d u / d axis at a cell, from its neighbours along the axis (`stride` apart, `at` of `n`) that hold something.
Vec3 derivative(const std::vector<Vec3>& u, size_t cell, size_t stride, int at, int n, double edge) {
  const auto known = [&](size_t k) { return !std::isnan(u[k].x); };
  const bool before = at > 0 && known(cell - stride), after = at + 1 < n && known(cell + stride);
  const Vec3& low = u[before ? cell - stride : cell];
  const Vec3& high = u[after ? cell + stride : cell];
  const int steps = int{before} + int{after};
  return steps == 0 ? Vec3{0, 0, 0} : 1 / (steps * edge) * (high - low);
}

double squared_gradient(const CoarseGrid& g, const std::vector<Vec3>& u, size_t cell) {
  const size_t nx = g.cells[0], ny = g.cells[1];
  const Vec3 x = derivative(u, cell, 1, static_cast<int>(cell % nx), g.cells[0], g.spacing.x);
  const Vec3 y = derivative(u, cell, nx, static_cast<int>(cell / nx % ny), g.cells[1], g.spacing.y);
  const Vec3 z = derivative(u, cell, nx * ny, static_cast<int>(cell / (nx * ny)), g.cells[2], g.spacing.z);
  return dot(x, x) + dot(y, y) + dot(z, z);
}

// Of each cell's volume, at 3 x 3 x 3 points.
std::vector<double> free_shares(const CoarseGrid& g, const Case& c) {
  constexpr int kPoints = 3;
  std::vector<uint32_t> inside(g.size(), 0);  // a bit a point
  for (const Primitive& p : c.solid.primitives) {
    if (p.radius == 0) continue;
    const PreparedPrimitive fibre = prepared(p);
    const Bounds b = bounds_of(p);
    const auto range = [](double low, double high, double from, double edge, int n) {
      const auto cell = [&](double x) { return std::clamp(static_cast<int>(std::floor((x - from) / edge)), 0, n - 1); };
      return high < from || low > from + n * edge ? std::array{0, -1} : std::array{cell(low), cell(high)};
    };
    const auto x = range(b.min.x, b.max.x, g.origin.x, g.spacing.x, g.cells[0]);
    const auto y = range(b.min.y, b.max.y, g.origin.y, g.spacing.y, g.cells[1]);
    const auto z = range(b.min.z, b.max.z, g.origin.z, g.spacing.z, g.cells[2]);
    for (int k = z[0]; k <= z[1]; ++k)
      for (int j = y[0]; j <= y[1]; ++j)
        for (int i = x[0]; i <= x[1]; ++i)
          for (int point = 0; point < kPoints * kPoints * kPoints; ++point) {
            const auto at = [&](int cell, int sub) { return cell + (sub + 0.5) / kPoints; };
            const Vec3 place =
                g.origin + Vec3{g.spacing.x * at(i, point % kPoints), g.spacing.y * at(j, point / kPoints % kPoints),
                                g.spacing.z * at(k, point / (kPoints * kPoints))};
            if (distance(fibre, place) < 0) inside[(size_t(k) * g.cells[1] + j) * g.cells[0] + i] |= 1u << point;
          }
  }
  std::vector<double> shares(g.size());
  for (size_t k = 0; k < shares.size(); ++k) shares[k] = 1 - std::popcount(inside[k]) / 27.0;
  return shares;
}

}  // namespace

AverageSums::AverageSums(const CoarseGrid& grid)
    : grid_(grid), grains_(grid.size() * kGrainValues, 0.0), stresses_(grid.size() * kStressValues, 0.0) {}

void AverageSums::add(const Engine& engine, const Case& c) {
  add_grains(engine);
  std::vector<double> radii(engine.count());
  parallel_for_each(radii.size(), [&](size_t k) { radii[k] = engine.particle(k).radius; });
  engine.visit_contacts([&](std::span<const ContactState> contacts) {
    std::vector<StressSample> stresses = stress_samples(contacts, radii);
    wrap_into(c, stresses);
    deposit<kStressValues>(grid_, stresses, stresses_);
  });
  ++looks_;
}

void AverageSums::add_grains(const Engine& engine) {
  std::vector<GrainSample> grains;  // some at a time
  for (const ParticleState& p : each_particle(engine)) {
    if (!grid_.holds(p.position)) continue;
    grains.push_back(sample_of(p));
    if (grains.size() < kGrainsAtOnce) continue;
    deposit<kGrainValues>(grid_, grains, grains_);
    grains.clear();
  }
  deposit<kGrainValues>(grid_, grains, grains_);
}

AverageFields AverageSums::fields(const Case& c) const {
  const size_t n = grid_.size();
  const double share = looks_ > 0 ? 1 / (static_cast<double>(looks_) * grid_.cell_volume()) : 0;
  AverageFields f;
  f.solid_fraction.resize(n), f.bulk_density.resize(n), f.temperature.assign(n, kNothing);
  f.velocity.assign(n, {kNothing, kNothing, kNothing}), f.mass_flux.resize(n);
  f.stress.resize(n), f.kinetic_stress.resize(n);
  parallel_for_each(n, [&](size_t k) {
    const double* g = &grains_[k * kGrainValues];
    f.solid_fraction[k] = share * g[kVolume];
    f.bulk_density[k] = share * g[kMass];
    const Vec3 momentum{g[kMomentum], g[kMomentum + 1], g[kMomentum + 2]};
    f.mass_flux[k] = share * momentum;
    for (size_t s = 0; s < kStressValues; ++s) f.stress[k][s] = share * stresses_[k * kStressValues + s];
    if (!(g[kMass] > 0)) return;
    const Vec3 u = 1 / g[kMass] * momentum;
    f.velocity[k] = u;
    const double own[6] = {u.x * u.x, u.y * u.y, u.z * u.z, u.x * u.y, u.y * u.z, u.x * u.z};
    for (size_t s = 0; s < kStressValues; ++s) {
      f.kinetic_stress[k][s] = share * (g[kFlow + s] - g[kMass] * own[s]);
      f.stress[k][s] += f.kinetic_stress[k][s];
    }
  });
  parallel_for_each(n, [&](size_t k) {
    if (!(f.bulk_density[k] > 0)) return;
    const auto& s = f.kinetic_stress[k];
    const double spread = (s[0] + s[1] + s[2]) / (3 * f.bulk_density[k]);
    f.temperature[k] = std::max(0.0, spread - kernel_variance(grid_) / 3 * squared_gradient(grid_, f.velocity, k));
  });
  f.free_share = free_shares(grid_, c);
  return f;
}

void AverageSums::save(StateWriter& out, const std::string& at) const {
  out.save(at + "/looks", looks_), out.save(at + "/grains", grains_), out.save(at + "/stresses", stresses_);
}

void AverageSums::load(StateReader& in, const std::string& at) {
  in.load(at + "/looks", looks_);
  in.array(at + "/grains", std::span<double>(grains_)), in.array(at + "/stresses", std::span<double>(stresses_));
}

}  // namespace scree
