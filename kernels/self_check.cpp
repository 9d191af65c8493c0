#include "kernels/self_check.h"

#include <cstring>
#include <vector>

#include "kernels/step_table.h"

namespace scree {

namespace {

constexpr uint32_t kSide = 5, kCount = kSide * kSide * kSide;  // more than seven blocks of pairs, the last not full
constexpr float kRadius = 2e-4f;

// Particles on a cubic grid a little closer than touching, pushed about by fixed small amounts.
std::vector<Particle<float>> heap() {
  std::vector<Particle<float>> particles(kCount + 2);
  uint32_t noise = 12345;
  const auto some = [&noise](float most) {
    noise = noise * 1664525u + 1013904223u;
    return most * (static_cast<float>(noise >> 8) / 8388608.0f - 1.0f);
  };
  for (uint32_t k = 0; k < kCount; ++k) {
    Particle<float>& p = particles[k];
    const double pitch = 1.99 * kRadius;
    const uint32_t row = k / kSide % kSide, layer = k / kSide / kSide;
    p.x = pitch * (k % kSide) + some(1e-6f), p.y = pitch * row + some(1e-6f), p.z = pitch * layer + some(1e-6f);
    p.tag = Particle<float>::make_tag(0, k);
    p.vx = some(0.3f), p.vy = some(0.3f), p.vz = some(0.3f);
    p.wx = some(500), p.wy = some(500), p.wz = some(500);
    p.radius = kRadius * (1 + some(0.05f)), p.inverse_mass = 9.7e6f * (1 + some(0.1f));
  }
  for (uint32_t k = kCount; k < kCount + 2; ++k) particles[k] = {-1.0 - k, -1, -1, 0, 0, 0, 0, 0, 0, 0, -1, 1};
  return particles;
}

ChunkContacts<float> neighbours() {
  ChunkContacts<float> contacts;
  contacts.clear(0, kCount, kCount);
  for (uint32_t k = 0; k < kCount; ++k) {
    if (k % kSide + 1 < kSide) contacts.append(k, k + 1);
    if (k / kSide % kSide + 1 < kSide) contacts.append(k, k + kSide);
    if (k + kSide * kSide < kCount) (k % 2 ? contacts.near : contacts.far).push_back({k, k + kSide * kSide});
  }
  return contacts;
}

struct Outcome {
  std::vector<Particle<float>> particles;
  ChunkContacts<float> contacts;
};

Outcome stepped(const StepKernels<float>& kernels, bool uniform) {
  MaterialTable<float> materials;
  materials.kinds = materials.columns = 1, materials.uniform_pairs = materials.uniform_walls = uniform;
  materials.rows.resize(1);
  materials.set(0, 0, {5.4e6, 1.1e6, 900, 800, 0.5, 0.4});
  const StepSettings settings{.dt = 5e-6,
                              .kick = 5e-6,
                              .history_dt = 5e-6,
                              .gravity = {0, 0, -9.81},
                              .period = {},
                              .inverse_period = {},
                              .limit_attraction = false,
                              .speed_limit = 1e3,
                              .profile = false};
  Outcome o{heap(), neighbours()};
  std::vector<Particle<float>> next = o.particles;
  std::vector<float> storage((kCount + 1) * 8 + 16);
  const size_t off = (64 - reinterpret_cast<uintptr_t>(storage.data()) % 64) / sizeof(float);
  for (int step = 0; step < 3; ++step) {
    kernels.step({o.particles.data(),
                  next.data(),
                  0,
                  kCount,
                  kCount,
                  &o.contacts,
                  &materials,
                  {},
                  {},
                  {},
                  &settings,
                  Look::all,
                  storage.data() + off});
    std::swap(o.particles, next);
  }
  return o;
}

bool same_bits(const auto& a, const auto& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0;
}

}  // namespace

bool agrees_with_scalar(const StepKernels<float>& kernels, const KernelChoice& choice) {
  const Outcome a = stepped(kernels, choice.uniform), b = stepped(scalar_kernels(choice), choice.uniform);
  return same_bits(a.particles, b.particles) && same_bits(a.contacts.blocks, b.contacts.blocks);
}

}  // namespace scree
