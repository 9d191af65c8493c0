// Each contact law alone: over contacts that stay in the first-level cache, with one lane and with the widest.
#include "kernels/contact_law.h"

#include <memory>

#include "bench/measure.h"
#include "kernels/materials.h"
#include "kernels/simd.h"
#include "runtime/random.h"

namespace scree::bench {
namespace {

constexpr int kContacts = 256;  // 30 kB with what they give back

template <class Real>
struct alignas(64) Contacts {
  Real in[15][kContacts];  // the members of Contact, in order
  Real history[6][kContacts];
  Real out[9][kContacts];  // the members of Reaction, in order
};

// Touching grains of 400 um as a flowing bed has them, some sticking, some sliding.
template <class Real>
std::unique_ptr<Contacts<Real>> flowing_contacts() {
  auto c = std::make_unique<Contacts<Real>>();
  Random random(1, 1);
  const auto fill = [&](Real(*row)[kContacts], int k, const Vec3& v) {
    row[0][k] = static_cast<Real>(v.x), row[1][k] = static_cast<Real>(v.y), row[2][k] = static_cast<Real>(v.z);
  };
  const auto vector = [&](double size) {
    return Vec3{random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
  };
  for (int k = 0; k < kContacts; ++k) {
    fill(c->in, k, unit(vector(1)));
    c->in[3][k] = static_cast<Real>(random.uniform(1e-8, 1e-6));  // overlap
    c->in[4][k] = static_cast<Real>(1e-4), c->in[5][k] = static_cast<Real>(5e-8);
    fill(c->in + 6, k, vector(0.02)), fill(c->in + 9, k, vector(0.02)), fill(c->in + 12, k, vector(50));
    fill(c->history, k, vector(2e-7)), fill(c->history + 3, k, vector(1e-9));
  }
  return c;
}

template <class L>
Vec<typename L::F> load_vec(const typename L::Real (*row)[kContacts], int k) {
  return {L::load(row[0] + k), L::load(row[1] + k), L::load(row[2] + k)};
}

template <class L>
void store_vec(const Vec<typename L::F>& v, typename L::Real (*row)[kContacts], int k) {
  L::store(v.x, row[0] + k), L::store(v.y, row[1] + k), L::store(v.z, row[2] + k);
}

template <class L, RollingModel rolling>
void apply_law(Contacts<typename L::Real>& c, const PairConstants<typename L::F>& constants, double dt) {
  using F = typename L::F;
  for (int k = 0; k < kContacts; k += L::width) {
    const Contact<F> contact{load_vec<L>(c.in, k),     L::load(c.in[3] + k),     L::load(c.in[4] + k),
                             L::load(c.in[5] + k),     load_vec<L>(c.in + 6, k), load_vec<L>(c.in + 9, k),
                             load_vec<L>(c.in + 12, k)};
    ContactHistory<F> history{load_vec<L>(c.history, k), load_vec<L>(c.history + 3, k)};
    const Reaction<F> r = hertz_mindlin<rolling>(contact, constants, F(dt), false, history);
    store_vec<L>(history.tangential_displacement, c.history, k);
    store_vec<L>(history.rolling_torque, c.history + 3, k);
    store_vec<L>(r.force, c.out, k), store_vec<L>(r.lever_torque, c.out + 3, k), store_vec<L>(r.rolling, c.out + 6, k);
  }
}

// Time runs forth and back in turn, so that the springs do not all end at Coulomb's limit.
template <class L, RollingModel rolling>
void contact_law(benchmark::State& state) {
  using F = typename L::F;
  const auto contacts = flowing_contacts<typename L::Real>();
  const PairConstants<double> p = pair_constants({1e7, 0.28}, {1e7, 0.28}, 0.52, 0.53, 0.37);
  const PairConstants<F> constants{F(p.effective_youngs),   F(p.effective_shear),  F(p.normal_damping),
                                   F(p.tangential_damping), F(p.sliding_friction), F(p.rolling_friction)};
  double dt = 5e-6;
  for (auto _ : state) {
    apply_law<L, rolling>(*contacts, constants, dt);
    benchmark::DoNotOptimize(contacts->out);
    benchmark::ClobberMemory();
    dt = -dt;
  }
  set_rate(state, "contacts/s", static_cast<double>(kContacts * state.iterations()));
  Hash hash;
  for (const auto& row : contacts->out)
    for (const auto x : row) hash.add(static_cast<double>(x));
  state.SetLabel(hash.text());
}

template <class L>
void register_laws(const std::string& lanes) {
  const auto add = [&](const std::string& rolling, void (*run)(benchmark::State&)) {
    benchmark::RegisterBenchmark(("contact_law/hertz_mindlin+" + rolling + "/" + lanes).c_str(), run)
        ->Iterations(40000)
        ->Unit(benchmark::kMicrosecond);
  };
  add("none", contact_law<L, RollingModel::none>);
  add("cdt", contact_law<L, RollingModel::cdt>);
  add("epsd2", contact_law<L, RollingModel::epsd2>);
}

void register_all() {
  register_laws<HWY_NAMESPACE::NativeLanes>("native");
  register_laws<ScalarLanes<float>>("scalar");
  register_laws<ScalarLanes<double>>("reference");
}

[[maybe_unused]] const bool kRegistered = (register_all(), true);

}  // namespace
}  // namespace scree::bench
