// Contacts of a chunk's particles with the solid: fibres, walls.
//
// Particles in lanes, the primitives near them in slots. The solid is the *union* of its primitives (physics.md): after
// all slots are evaluated, a contact point that lies in or on another touching primitive is buried and exerts nothing;
// of contacts that are one point of several surfaces (a cap shared by fibres, an edge shared by walls) the deepest
// stays.
//
//        \  a  /            x touches a and b. a's point pa lies inside b: buried. b's point pb is on the surface of
//      ---\pa/----  b       the union: felt.
//          \/ pb
//
// A contact that passes from one primitive to the next at one point (rolling across a node) hands its history over.
#pragma once

#include <cstring>

#include "kernels/pair_pass.h"

namespace scree {

// Contact points this close (share of the particle's radius) to another primitive's surface are on it. Far above the
// round-off of a float distance (1e-7) and far below what a contact force resolves.
inline constexpr double kBuriedTolerance = 1e-5;
// A contact handed over from one primitive to another may have moved this far (share of the radius) in one step.
inline constexpr double kHandOverReach = 0.05;

template <class L, template <class> class Skeleton>
inline Rounded<Skeleton, typename L::D> gather_rounded(const Rounded<Skeleton, double>* table, const uint32_t* index) {
  using D = typename L::D;
  constexpr int count = sizeof(Rounded<Skeleton, double>) / sizeof(double);
  static_assert(count % 4 == 0);
  D values[count];
  for (int k = 0; k < count; k += 4) {
    const double* rows[L::width];
    for (int lane = 0; lane < L::width; ++lane) rows[lane] = reinterpret_cast<const double*>(table + index[lane]) + k;
    L::load_double_rows(rows, reinterpret_cast<D(&)[4]>(values[k]));
  }
  Rounded<Skeleton, D> result;
  std::memcpy(static_cast<void*>(&result), values, sizeof(Skeleton<D>) + sizeof(D));
  return result;
}

template <class D>
struct ClosestPoint {
  Vec<D> point;  // of the skeleton
  D radius;      // rounding radius
};

// One SolidBlock's worth of lanes while it is worked on.
template <class L>
struct SolidLanes {
  using F = typename L::F;
  using D = typename L::D;
  using Real = typename L::Real;
  using Mask = decltype(F(0) > F(0));

  const ChunkTask<Real>& task;
  const SolidBlock& block;
  const SolidSlot<Real>* slots;
  int lane;  // first lane of the block that is worked on
  Bodies<L> i;

  Vec<F> normal[kMaxSlots];
  F overlap[kMaxSlots];
  Vec<F> point[kMaxSlots];  // contact point on the surface, relative to the particle's centre
  Mask touching[kMaxSlots], kept[kMaxSlots];

  // The arrays are left as they are: only the block's slots are written and read.
  SolidLanes(const ChunkTask<Real>& t, const SolidBlock& b, const SolidSlot<Real>* s, int first_lane)
      : task(t),
        block(b),
        slots(s),
        lane(first_lane),
        i(gather_bodies<L>(t.old_particles + t.begin, b.i + first_lane)) {}

  const uint32_t* primitives(uint32_t s) const { return slots[s].primitive + lane; }

  ClosestPoint<D> closest(uint32_t s, const Vec<D>& x) const {
    const auto find = [&](const auto& table) {
      const auto rounded = gather_rounded<L>(table.rows, primitives(s));
      return ClosestPoint<D>{closest_on(rounded.skeleton, x), rounded.radius};
    };
    if (s < block.segments) return find(task.segments);
    if (s < uint32_t{block.segments} + block.quads) return find(task.quads);
    return find(task.revolutions);
  }
  const SolidSurface<Real>* surface(uint32_t s) const {
    if (s < block.segments) return task.segments.surface;
    if (s < uint32_t{block.segments} + block.quads) return task.quads.surface;
    return task.revolutions.surface;
  }

  // Pre: i is read. Post: normal, overlap, point, touching of slot s. Returns whether any lane touches.
  bool evaluate(uint32_t s) {
    const ClosestPoint<D> near = closest(s, i.position);
    const Vec<D> d = i.position - near.point;
    const D distance2 = dot(d, d);
    const D reach = L::widen(i.radius) + near.radius;
    const F distance = sqrt(L::narrow(distance2));
    overlap[s] = overlap_from<L>(reach, distance2, distance);
    normal[s] = (F(1) / distance) * narrow<L>(d);
    point[s] = (L::narrow(near.radius) - distance) * normal[s];
    touching[s] = kept[s] = overlap[s] > F(0);
    return any(touching[s]);
  }

  // Distance of slot s's contact point from slot other's surface, m.
  F gap(uint32_t s, uint32_t other) const {
    const Vec<D> p = i.position + Vec<D>{L::widen(point[s].x), L::widen(point[s].y), L::widen(point[s].z)};
    const ClosestPoint<D> near = closest(other, p);
    const Vec<D> d = p - near.point;
    return L::narrow(sqrt(dot(d, d)) - near.radius);
  }

  void bury() {
    const F tolerance = F(kBuriedTolerance) * i.radius;
    const uint32_t count = block.slots();
    for (uint32_t a = 0; a < count; ++a)
      for (uint32_t b = a + 1; b < count; ++b) {
        const Mask both = touching[a] & touching[b];
        if (!any(both)) continue;
        const Mask a_in_b = both & (gap(a, b) < tolerance), b_in_a = both & (gap(b, a) < tolerance);
        // Each in or on the other: one point of both surfaces. The deeper one is the true contact; the other is the
        // nearest cap or edge, tilted by what the tolerance lets through.
        const Mask a_deeper = overlap[a] >= overlap[b];
        kept[b] = kept[b] & !(b_in_a & (a_deeper | !a_in_b));
        kept[a] = kept[a] & !(a_in_b & !(b_in_a & a_deeper));
      }
  }

  ContactHistory<F> history(uint32_t s) const { return load_history<L>(slots[s].history[0] + lane); }
  Mask live(uint32_t s) const { return L::mask_from_bits(slots[s].live >> lane); }

  // What slot s remembers: its own history, or that of a contact at the same point that was just buried.
  ContactHistory<F> inherited(uint32_t s) const {
    const Mask fresh = kept[s] & !live(s);
    ContactHistory<F> result = select_history(live(s), history(s), no_history<F>());
    if (!any(fresh)) return result;
    for (uint32_t other = 0; other < block.slots(); ++other) {
      if (other == s || ((slots[other].live >> lane) & ((1u << L::width) - 1)) == 0) continue;
      const Vec<F> apart = point[s] - point[other];
      const Mask from = fresh & live(other) & !kept[other] &
                        (dot(apart, apart) < F(kHandOverReach * kHandOverReach) * (i.radius * i.radius));
      result = select_history(from, history(other), result);
    }
    return result;
  }
};

template <class L, class Traits>
inline PairConstants<typename L::F> solid_constants_of(const SolidLanes<L>& lanes, uint32_t s) {
  using Real = typename L::Real;
  const ChunkTask<Real>& task = lanes.task;
  if constexpr (Traits::uniform) return broadcast_constants<L>(task.materials->row(0, task.materials->columns - 1));
  const Real* rows[L::width];
  for (int k = 0; k < L::width; ++k)
    rows[k] = task.materials->row(task.old_particles[task.begin + lanes.block.i[lanes.lane + k]].kind(),
                                  lanes.surface(s)[lanes.primitives(s)[k]].column);
  return gather_constants<L>(rows);
}

template <class L>
inline Vec<typename L::F> surface_velocity(const SolidLanes<L>& lanes, uint32_t s) {
  typename L::Real v[3][L::width];
  for (int k = 0; k < L::width; ++k) {
    const auto& u = lanes.surface(s)[lanes.primitives(s)[k]].velocity;
    v[0][k] = u.x, v[1][k] = u.y, v[2][k] = u.z;
  }
  return {L::load(v[0]), L::load(v[1]), L::load(v[2])};
}

// Slot s's contact as the law sees it.
template <class L>
inline Contact<typename L::F> solid_contact_of(const SolidLanes<L>& lanes, uint32_t s) {
  using F = typename L::F;
  const Bodies<L>& i = lanes.i;
  Contact<F> c;
  c.normal = lanes.normal[s];
  c.overlap = max(lanes.overlap[s], F(0));
  c.effective_radius = max(i.radius, F(0));
  c.effective_mass = F(1) / i.inverse_mass;
  c.velocity = i.velocity - surface_velocity(lanes, s);
  const F arm = i.radius - F(0.5) * c.overlap;
  c.arm_spin = arm * i.spin;
  c.rolling_spin = (arm / (i.radius - c.overlap)) * i.spin;
  return c;
}

// The powers of one slot's contact, and the solid's force. A wall's rolling_spin is not the spin that the torque acts
// on.
template <class L>
inline void add_solid_work(const SolidLanes<L>& lanes, uint32_t s, Contact<typename L::F> c,
                           const Reaction<typename L::F>& r, BlockWork<typename L::Real>& work) {
  using F = typename L::F;
  using Row = BlockWork<typename L::Real>;
  c.rolling_spin = lanes.i.spin;
  add_powers<L>(c, r, F(1), lanes.kept[s], work, lanes.lane);
  const auto note = [&](typename Row::Row row, const F& value) {
    add_row<L>(work.value[row] + lanes.lane, select(lanes.kept[s], value, F(0)));
  };
  note(Row::walls, dot(r.force, surface_velocity(lanes, s)));
  note(Row::force_x, r.force.x), note(Row::force_y, r.force.y), note(Row::force_z, r.force.z);
}

// The law on one slot: adds to force and torque of the lanes' particles, updates the history given.
template <class L, class Traits>
inline void solid_contact(const SolidLanes<L>& lanes, uint32_t s, ContactHistory<typename L::F>& history,
                          Vec<typename L::F>& force, Vec<typename L::F>& torque, WorkOf<L, Traits>& work) {
  using F = typename L::F;
  const Contact<F> c = solid_contact_of(lanes, s);
  const Reaction<F> r =
      hertz_mindlin<Traits::rolling>(c, solid_constants_of<L, Traits>(lanes, s), F(lanes.task.settings->history_dt),
                                     lanes.task.settings->limit_attraction, history);
  const F arm = lanes.i.radius - F(0.5) * c.overlap;
  const Vec<F> zero{F(0), F(0), F(0)};
  force += select_vec(lanes.kept[s], r.force, zero);
  torque += select_vec(lanes.kept[s], nfms(arm, r.lever_torque, r.rolling), zero);
  if constexpr (Traits::ledger) add_solid_work(lanes, s, c, r, work);
}

template <class L, class Traits>
inline void solid_lanes(const ChunkTask<typename L::Real>& task, const SolidBlock& block,
                        SolidSlot<typename L::Real>* slots, int lane, typename L::F& max_share,
                        WorkOf<L, Traits>& work) {
  using F = typename L::F;
  SolidLanes<L> lanes(task, block, slots, lane);
  const uint32_t count = block.slots();
  unsigned touched = 0;
  for (uint32_t s = 0; s < count; ++s) touched += lanes.evaluate(s);
  if (touched > 1) lanes.bury();

  const unsigned here = ((1u << L::width) - 1) << lane;
  Vec<F> force{F(0), F(0), F(0)}, torque = force;
  ContactHistory<F> histories[kMaxSlots];
  if (touched > 0)
    for (uint32_t s = 0; s < count; ++s)
      if (any(lanes.kept[s])) histories[s] = lanes.inherited(s);
  for (uint32_t s = 0; s < count; ++s) {
    const unsigned kept = L::bits(lanes.kept[s]) << lane;
    slots[s].live = (slots[s].live & ~here) | kept;
    if (kept == 0) continue;
    max_share = max(max_share, select(lanes.kept[s], lanes.overlap[s] / lanes.i.radius, F(0)));
    solid_contact<L, Traits>(lanes, s, histories[s], force, torque, work);
    store_history<L>(histories[s], slots[s].history[0] + lane);
  }
  if (touched > 0) add_to_rows<L>(task, block.i + lane, force, torque);
}

template <class L, class Traits>
inline PassOutcome solid_pass(const ChunkTask<typename L::Real>& task) {
  using F = typename L::F;
  PassOutcome outcome;
  F max_share(0);
  for (const SolidBlock& block : task.contacts->solid_blocks) {
    WorkOf<L, Traits> work;
    for (int lane = 0; lane < kBlock; lane += L::width)
      solid_lanes<L, Traits>(task, block, task.contacts->slots.data() + block.first_slot, lane, max_share, work);
    if constexpr (Traits::ledger) work.add_to(outcome.ledger);
  }
  outcome.max_overlap = L::max_lane(max_share);
  return outcome;
}

}  // namespace scree
