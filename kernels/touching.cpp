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

// The force of the step that comes next. Rolling resistance is a torque, not asked for.
template <class L>
Reaction<typename L::F> reaction_of(const ChunkTask<typename L::Real>& task, const Contact<typename L::F>& c,
                                    const PairConstants<typename L::F>& constants,
                                    ContactHistory<typename L::F> history) {
  return hertz_mindlin<RollingModel::none>(c, constants, typename L::F(task.settings->dt),
                                           task.settings->limit_attraction, history);
}

// What the law makes of a vector of contacts, lane by lane.
template <class L>
class LawLanes {
 public:
  using F = typename L::F;

  LawLanes(const ChunkTask<typename L::Real>& task, const Contact<F>& c, const PairConstants<F>& constants,
           ContactHistory<F> history) {
    const Reaction<F> r = reaction_of<L>(task, c, constants, history);
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

// see(lanes, s) for every slot with lanes that touch and are not buried.
template <class L>
void each_touching_slot(const ChunkTask<typename L::Real>& task, const SolidBlock& block,
                        const SolidSlot<typename L::Real>* slots, int first, const auto& see) {
  SolidLanes<L> lanes(task, block, slots, first);
  unsigned touched = 0;
  for (uint32_t s = 0; s < block.slots(); ++s) touched += lanes.evaluate(s);
  if (touched == 0) return;
  if (touched > 1) lanes.bury();
  for (uint32_t s = 0; s < block.slots(); ++s)
    if (L::bits(lanes.kept[s]) != 0) see(lanes, s);
}

// Lanes first..first + L::width - 1 of a block of particles beside the solid.
template <class L>
void visit_solid_lanes(const ChunkTask<typename L::Real>& task, const SolidBlock& block,
                       const SolidSlot<typename L::Real>* slots, int first, const VisitTouching& visit) {
  each_touching_slot<L>(task, block, slots, first, [&](const SolidLanes<L>& lanes, uint32_t s) {
    const LawLanes<L> law(task, solid_contact_of(lanes, s), solid_constants_of<L, Traits>(lanes, s),
                          lanes.inherited(s));
    typename LawLanes<L>::Row point[3];
    LawLanes<L>::store(lanes.point[s], point);
    const int kind = s < block.segments ? 0 : s < uint32_t{block.segments} + block.quads ? 1 : 2;
    for_each_bit(L::bits(lanes.kept[s]), [&](int lane) {
      TouchingContact seen{
          .i = task.begin + block.i[first + lane], .j = slots[s].primitive[first + lane], .skeleton = kind};
      law.read(lane, seen);
      seen.point = position_of(task.old_particles[seen.i]) + LawLanes<L>::at(point, lane);
      visit(seen);
    });
  });
}

// A vector of contacts as the sums of its particles see it.
template <class L>
struct SumLanes {
  using F = typename L::F;
  using Mask = decltype(F(0) > F(0));
  F one;  // 0 in lanes that do not touch
  Vec<F> force;
  F product[6];  // sym(n (x) f)

  SumLanes() = default;
  SumLanes(const Mask& touching, const Vec<F>& normal, const Vec<F>& f)
      : one(select(touching, F(1), F(0))), force(select_vec(touching, f, Vec<F>{F(0), F(0), F(0)})) {
    const Vec<F> n = select_vec(touching, normal, Vec<F>{F(0), F(0), F(0)});  // of padding it may be no number
    const F half(0.5);
    product[0] = n.x * force.x, product[1] = n.y * force.y, product[2] = n.z * force.z;
    product[3] = half * (n.x * force.y + n.y * force.x);
    product[4] = half * (n.y * force.z + n.z * force.y);
    product[5] = half * (n.x * force.z + n.z * force.x);
  }
  // `sign`: of the force on these particles. From one of a pair to the other both force and normal turn round, so that
  // their product does not.
  void add(typename L::Real* rows, const uint16_t* row, const F& sign, const F& arm, bool solid) const {
    typename L::Real *low[L::width], *high[L::width];
    for (int k = 0; k < L::width; ++k) low[k] = rows + kSumRow * row[k], high[k] = low[k] + 8;
    const F zero(0);
    const F first[8] = {sign * force.x,   sign * force.y,   sign * force.z,   arm * product[0],
                        arm * product[1], arm * product[2], arm * product[3], arm * product[4]};
    const F second[8] = {arm * product[5], solid ? zero : one, solid ? one : zero, zero, zero, zero, zero, zero};
    L::add_rows(low, first), L::add_rows(high, second);
  }
};

// As in the step: the sixteen i rows of a block first, then the sixteen j rows.
template <class L, class Traits, bool wraps>
void sum_pair_block(const ChunkTask<typename L::Real>& task, const PairBlock<typename L::Real>& block,
                    typename L::Real* rows) {
  using F = typename L::F;
  constexpr int vectors = kBlock / L::width;
  PairGeometry<L> g[vectors];
  SumLanes<L> sums[vectors];
  bool any_touch = false;
  for (int k = 0; k < vectors; ++k) {
    const int lane = k * L::width;
    pair_lanes<L, wraps>(task, block, lane, g[k]);
    Contact<F>& c = g[k].contact;
    const auto touching = c.overlap > F(0);
    any_touch |= L::bits(touching) != 0;
    c.overlap = max(c.overlap, F(0));
    const auto constants = pair_constants_of<L, Traits>(task, block.i + lane, block.j + lane);
    const auto reaction = reaction_of<L>(task, c, constants, load_history<L>(block.history[0] + lane));
    sums[k] = SumLanes<L>(touching, c.normal, reaction.force);
  }
  if (!any_touch) return;
  for (int k = 0; k < vectors; ++k) sums[k].add(rows, block.i + k * L::width, F(1), g[k].arm_i, false);
  for (int k = 0; k < vectors; ++k) sums[k].add(rows, block.row + k * L::width, F(-1), g[k].arm_j, false);
}

template <class L, class Traits>
void sum_solid_lanes(const ChunkTask<typename L::Real>& task, const SolidBlock& block,
                     const SolidSlot<typename L::Real>* slots, int first, typename L::Real* rows) {
  each_touching_slot<L>(task, block, slots, first, [&](const SolidLanes<L>& lanes, uint32_t s) {
    const Contact<typename L::F> c = solid_contact_of(lanes, s);
    const auto r = reaction_of<L>(task, c, solid_constants_of<L, Traits>(lanes, s), lanes.inherited(s));
    const SumLanes<L> sum(lanes.kept[s], c.normal, r.force);
    sum.add(rows, block.i + first, typename L::F(1), lanes.i.radius - c.overlap, true);
  });
}

template <class L, class Traits>
void sum_chunk(const ChunkTask<typename L::Real>& task, const ChunkContacts<typename L::Real>& contacts,
               typename L::Real* rows) {
  for (size_t b = 0; b < contacts.blocks.size(); ++b)
    b < contacts.first_wrapping ? sum_pair_block<L, Traits, false>(task, contacts.blocks[b], rows)
                                : sum_pair_block<L, Traits, true>(task, contacts.blocks[b], rows);
  for (const SolidBlock& block : contacts.solid_blocks)
    for (int first = 0; first < kBlock; first += L::width)
      sum_solid_lanes<L, Traits>(task, block, contacts.slots.data() + block.first_slot, first, rows);
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

template <class Real>
void sum_touching(const ChunkTask<Real>& task, const ChunkContacts<Real>& contacts, Real* rows) {
  const MaterialTable<Real>& materials = *task.materials;
  if (materials.uniform_pairs && materials.uniform_walls)
    sum_chunk<WidestLanes<Real>, PassTraits<RollingModel::none, true>>(task, contacts, rows);
  else
    sum_chunk<WidestLanes<Real>, Traits>(task, contacts, rows);
}

template void visit_touching_pairs(const ChunkTask<float>&, const ChunkContacts<float>&, const VisitTouching&);
template void visit_touching_pairs(const ChunkTask<double>&, const ChunkContacts<double>&, const VisitTouching&);
template void visit_touching_solids(const ChunkTask<float>&, const ChunkContacts<float>&, const VisitTouching&);
template void visit_touching_solids(const ChunkTask<double>&, const ChunkContacts<double>&, const VisitTouching&);
template void sum_touching(const ChunkTask<float>&, const ChunkContacts<float>&, float*);
template void sum_touching(const ChunkTask<double>&, const ChunkContacts<double>&, double*);

}  // namespace scree
