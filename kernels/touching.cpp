#include "kernels/touching.h"

#include <bit>
#include <type_traits>

#include "kernels/pair_pass.h"
#include "kernels/solid_pass.h"

namespace scree {

namespace {

template <class Real>
using WidestLanes = std::conditional_t<std::is_same_v<Real, float>, HWY_NAMESPACE::NativeLanes, ScalarLanes<Real>>;
using Traits = PassTraits<RollingModel::none, false>;

// What the law makes of a vector of contacts, lane by lane.
template <class L>
class LawLanes {
 public:
  using F = typename L::F;

  // The force of the step that comes next. Rolling resistance is a torque, not asked for.
  LawLanes(const ChunkTask<typename L::Real>& task, const Contact<F>& c, const PairConstants<F>& constants,
           ContactHistory<F> history) {
    const Reaction<F> r =
        hertz_mindlin<RollingModel::none>(c, constants, F(task.settings->dt), task.settings->limit_attraction, history);
    L::store(c.overlap, overlap_), L::store(r.elastic, elastic_);
    store(c.normal, normal_), store(r.force, force_);
    store(c.velocity - dot(c.velocity, c.normal) * c.normal + cross(c.normal, c.arm_spin), slip_);
  }
  void read(int lane, TouchingContact& seen) const {
    seen.overlap = static_cast<double>(overlap_[lane]);
    seen.elastic_energy = 0.4 * static_cast<double>(elastic_[lane]) * seen.overlap;
    seen.normal = at(normal_, lane), seen.force = at(force_, lane), seen.slip = at(slip_, lane);
  }

  using Row = typename L::Real[L::width];
  static void store(const Vec<F>& v, Row (&to)[3]) { L::store(v.x, to[0]), L::store(v.y, to[1]), L::store(v.z, to[2]); }
  static Vec<double> at(const Row (&v)[3], int lane) {
    return {static_cast<double>(v[0][lane]), static_cast<double>(v[1][lane]), static_cast<double>(v[2][lane])};
  }

 private:
  Row overlap_, elastic_, normal_[3], force_[3], slip_[3];
};

void for_each_bit(unsigned bits, const auto& see) {
  for (; bits != 0; bits &= bits - 1) see(std::countr_zero(bits));
}

template <class Real>
Vec<double> position_of(const Particle<Real>& p) {
  return {p.x, p.y, p.z};
}

// Pairs k..k + L::width - 1 of the chunk; those beyond its last are padding, which never touches.
template <class L>
void visit_pair_lanes(const ChunkTask<typename L::Real>& task, const ChunkContacts<typename L::Real>& contacts,
                      uint32_t k, const VisitTouching& visit) {
  using F = typename L::F;
  const PairBlock<typename L::Real>& block = contacts.blocks[k / kBlock];
  const int first = static_cast<int>(k % kBlock);
  PairGeometry<L> g;
  pair_lanes<L, true>(task, block, first, g);
  const unsigned touching = L::bits(g.contact.overlap > F(0));
  if (touching == 0) return;
  g.contact.overlap = max(g.contact.overlap, F(0));
  const LawLanes<L> law(task, g.contact, pair_constants_of<L, Traits>(task, block.i + first, block.j + first),
                        load_history<L>(block.history[0] + first));
  typename L::Real arm[L::width];
  L::store(g.arm_i, arm);
  for_each_bit(touching, [&](int lane) {
    TouchingContact seen{.i = contacts.pair_i(k + lane), .j = contacts.pair_j(k + lane)};
    law.read(lane, seen);
    seen.point = position_of(task.old_particles[seen.i]) - static_cast<double>(arm[lane]) * seen.normal;
    visit(seen);
  });
}

// Lanes first..first + L::width - 1 of a block of particles beside the solid.
template <class L>
void visit_solid_lanes(const ChunkTask<typename L::Real>& task, const SolidBlock& block,
                       const SolidSlot<typename L::Real>* slots, int first, const VisitTouching& visit) {
  SolidLanes<L> lanes(task, block, slots, first);
  unsigned touched = 0;
  for (uint32_t s = 0; s < block.slots(); ++s) touched += lanes.evaluate(s);
  if (touched == 0) return;
  if (touched > 1) lanes.bury();
  for (uint32_t s = 0; s < block.slots(); ++s) {
    const unsigned kept = L::bits(lanes.kept[s]);
    if (kept == 0) continue;
    const LawLanes<L> law(task, solid_contact_of(lanes, s), solid_constants_of<L, Traits>(lanes, s),
                          lanes.inherited(s));
    typename LawLanes<L>::Row point[3];
    LawLanes<L>::store(lanes.point[s], point);
    const int kind = s < block.segments ? 0 : s < uint32_t{block.segments} + block.quads ? 1 : 2;
    for_each_bit(kept, [&](int lane) {
      TouchingContact seen{
          .i = task.begin + block.i[first + lane], .j = slots[s].primitive[first + lane], .skeleton = kind};
      law.read(lane, seen);
      seen.point = position_of(task.old_particles[seen.i]) + LawLanes<L>::at(point, lane);
      visit(seen);
    });
  }
}

}  // namespace

template <class Real>
void visit_touching_pairs(const ChunkTask<Real>& task, const ChunkContacts<Real>& contacts,
                          const VisitTouching& visit) {
  using L = WidestLanes<Real>;
  for (uint32_t k = 0; k < contacts.pairs; k += L::width) visit_pair_lanes<L>(task, contacts, k, visit);
}

template <class Real>
void visit_touching_solids(const ChunkTask<Real>& task, const ChunkContacts<Real>& contacts,
                           const VisitTouching& visit) {
  using L = WidestLanes<Real>;
  for (const SolidBlock& block : contacts.solid_blocks)
    for (int first = 0; first < kBlock; first += L::width)
      visit_solid_lanes<L>(task, block, contacts.slots.data() + block.first_slot, first, visit);
}

template void visit_touching_pairs(const ChunkTask<float>&, const ChunkContacts<float>&, const VisitTouching&);
template void visit_touching_pairs(const ChunkTask<double>&, const ChunkContacts<double>&, const VisitTouching&);
template void visit_touching_solids(const ChunkTask<float>&, const ChunkContacts<float>&, const VisitTouching&);
template void visit_touching_solids(const ChunkTask<double>&, const ChunkContacts<double>&, const VisitTouching&);

}  // namespace scree
