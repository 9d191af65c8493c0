#include "kernels/touching.h"

#include "kernels/pair_pass.h"
#include "kernels/solid_pass.h"

namespace scree {

namespace {

template <class Real>
Vec<double> widened(const Vec<Real>& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

// The force of the step that comes next. Rolling resistance is a torque, not asked for.
template <class Real>
void apply_law(const ChunkTask<Real>& task, const Contact<Real>& c, const PairConstants<Real>& constants,
               ContactHistory<Real> history, TouchingContact& seen) {
  const Reaction<Real> r = hertz_mindlin<RollingModel::none>(c, constants, Real(task.settings->dt),
                                                             task.settings->limit_attraction, history);
  seen.overlap = static_cast<double>(c.overlap);
  seen.normal = widened(c.normal);
  seen.force = widened(r.force);
  seen.elastic_energy = 0.4 * static_cast<double>(r.elastic) * seen.overlap;
  seen.slip = widened(c.velocity - dot(c.velocity, c.normal) * c.normal + cross(c.normal, c.arm_spin));
}

template <class Real>
void visit_solids_of(const ChunkTask<Real>& task, const SolidBlock& block, const SolidSlot<Real>* slots, int lane,
                     const auto& visit) {
  using L = ScalarLanes<Real>;
  using Traits = PassTraits<RollingModel::none, false>;
  SolidLanes<L> lanes(task, block, slots, lane);
  unsigned touched = 0;
  for (uint32_t s = 0; s < block.slots(); ++s) touched += lanes.evaluate(s);
  if (touched > 1) lanes.bury();
  for (uint32_t s = 0; s < block.slots(); ++s) {
    if (!lanes.kept[s]) continue;
    const int kind = s < block.segments ? 0 : s < uint32_t{block.segments} + block.quads ? 1 : 2;
    TouchingContact seen{.i = task.begin + block.i[lane], .j = slots[s].primitive[lane], .skeleton = kind};
    apply_law(task, solid_contact_of(lanes, s), solid_constants_of<L, Traits>(lanes, s), lanes.inherited(s), seen);
    seen.point = lanes.i.position + widened(lanes.point[s]);
    visit(seen);
  }
}

}  // namespace

template <class Real>
void visit_touching_pairs(const ChunkTask<Real>& task, const ChunkContacts<Real>& contacts,
                          const VisitTouching& visit) {
  using L = ScalarLanes<Real>;
  for (uint32_t k = 0; k < contacts.pairs; ++k) {
    const PairBlock<Real>& block = contacts.blocks[k / kBlock];
    const int lane = static_cast<int>(k % kBlock);
    PairGeometry<L> g;
    pair_lanes<L, true>(task, block, lane, g);
    if (!(g.contact.overlap > 0)) continue;
    TouchingContact seen{.i = contacts.pair_i(k), .j = contacts.pair_j(k)};
    apply_law(task, g.contact,
              pair_constants_of<L, PassTraits<RollingModel::none, false>>(task, block.i + lane, block.j + lane),
              load_history<L>(block.history[0] + lane), seen);
    const Particle<Real>& i = task.old_particles[seen.i];
    seen.point = Vec<double>{i.x, i.y, i.z} - static_cast<double>(g.arm_i) * seen.normal;
    visit(seen);
  }
}

template <class Real>
void visit_touching_solids(const ChunkTask<Real>& task, const ChunkContacts<Real>& contacts,
                           const VisitTouching& visit) {
  for (const SolidBlock& block : contacts.solid_blocks)
    for (int lane = 0; lane < kBlock; ++lane)
      visit_solids_of(task, block, contacts.slots.data() + block.first_slot, lane, visit);
}

template void visit_touching_pairs(const ChunkTask<float>&, const ChunkContacts<float>&, const VisitTouching&);
template void visit_touching_pairs(const ChunkTask<double>&, const ChunkContacts<double>&, const VisitTouching&);
template void visit_touching_solids(const ChunkTask<float>&, const ChunkContacts<float>&, const VisitTouching&);
template void visit_touching_solids(const ChunkTask<double>&, const ChunkContacts<double>&, const VisitTouching&);

}  // namespace scree
