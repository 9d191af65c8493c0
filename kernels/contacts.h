// Where contacts live: per chunk of consecutive particles, in blocks that the SIMD loops walk.
//
// A chunk owns the contacts of its particles. A pair inside a chunk is stored once; a pair across two chunks is stored
// in both, each time with the inside particle as i. No atomics, no reduction, and the bits do not depend on threads:
//
//      chunk A           chunk B          stored in A: (1,2) (2,5)    in B: (5,2) (5,6)
//    [ 1 . 2 ] ------- [ 5 . 6 ]
//
// Pairs that are listed but too far apart to touch soon wait in `near`, and those further apart yet in `far`. Each list
// is looked through when the speeds of this chunk and of those beside it could have closed the gap that all its pairs
// had when it last was, and gives up those that have come closer: the short list often, the long one seldom.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace scree {

inline constexpr int kBlock = 16;  // contacts in a block, whatever the lanes' width

// i and row are counted from the chunk's first particle. `row` is where j's force goes: j's own row, or, for a j
// outside the chunk, the trash row after the chunk's last. Padding lanes pair the chunk's first particle with a dummy
// far away.
template <class Real>
struct alignas(64) PairBlock {
  uint16_t i[kBlock], row[kBlock];
  uint32_t j[kBlock];
  Real history[6][kBlock];  // tangential displacement x y z (m), rolling torque x y z (N m); zero when not touching
};

struct WaitingPair {
  uint32_t i, j;
};

// Which lists of waiting pairs a step looks through before its forces.
enum class Look : uint8_t { none, near, all };

// Sixteen particles, each with up to `slots` solid primitives near it. One block's slots hold one kind of skeleton
// each, in the order segments, quads, revolutions; padding names the kind's dummy primitive, far away.
struct SolidBlock {
  uint16_t i[kBlock];   // from the chunk's first particle
  uint32_t first_slot;  // into ChunkContacts::slots
  uint8_t segments, quads, revolutions;
  uint32_t slots() const { return uint32_t{segments} + quads + revolutions; }
};

template <class Real>
struct alignas(64) SolidSlot {
  uint32_t primitive[kBlock];  // row in the table of its skeleton kind
  Real history[6][kBlock];
  uint32_t live = 0;  // bit per lane: touched in the last step, so its history counts
};

inline constexpr uint32_t kMaxSlots = 192;  // solid primitives near one particle

template <class Real>
struct ChunkContacts {
  uint32_t begin = 0, end = 0, dummy = 0;  // the chunk; the particle that padding names
  std::vector<PairBlock<Real>> blocks;
  uint32_t pairs = 0;  // active pairs; the last block is padded
  // Blocks from this one on may hold pairs that are nearest through a periodic border; those before it spare the loops
  // the minimum image.
  size_t first_wrapping = kNoBlock;
  static constexpr size_t kNoBlock = ~size_t{0};
  std::vector<WaitingPair> near, far;
  std::vector<uint32_t> beside;  // other chunks that waiting pairs reach into
  double inner = 0, middle = 0;  // m beyond touching: closer pairs are active; closer pairs are not in `far`
  double near_closing = 0, far_closing = 0;  // m, bounds on any approach since the list was last looked through
  std::vector<SolidBlock> solid_blocks;
  std::vector<SolidSlot<Real>> slots;

  // Empties the lists; they are now of particles first..last - 1.
  void clear(uint32_t first, uint32_t last, uint32_t dummy_particle) {
    blocks.clear(), near.clear(), far.clear(), beside.clear(), solid_blocks.clear(), slots.clear();
    inner = middle = near_closing = far_closing = 0;
    pairs = 0, first_wrapping = kNoBlock;
    begin = first, end = last, dummy = dummy_particle;
  }
  void add_way(double way) { near_closing += way, far_closing += way; }
  // What the next step must look through; counts from there anew.
  Look take_look() {
    const auto due = [](double closing, double gap) { return closing > 0 && closing >= 0.999 * gap; };
    const Look look = due(far_closing, middle) ? Look::all : due(near_closing, inner) ? Look::near : Look::none;
    if (look != Look::none) near_closing = 0;
    if (look == Look::all) far_closing = 0;
    return look;
  }

  uint32_t pair_i(uint32_t k) const { return begin + blocks[k / kBlock].i[k % kBlock]; }
  uint32_t pair_j(uint32_t k) const { return blocks[k / kBlock].j[k % kBlock]; }

  // Appends an active pair; history all zero.
  PairBlock<Real>& append(uint32_t i, uint32_t j) {
    const uint32_t lane = pairs % kBlock;
    if (lane == 0) {
      PairBlock<Real>& b = blocks.emplace_back();
      for (int k = 0; k < kBlock; ++k) b.i[k] = 0, b.j[k] = dummy, b.row[k] = static_cast<uint16_t>(end - begin);
    }
    PairBlock<Real>& b = blocks.back();
    b.i[lane] = static_cast<uint16_t>(i - begin), b.j[lane] = j;
    b.row[lane] = static_cast<uint16_t>(j >= begin && j < end ? j - begin : end - begin);
    ++pairs;
    return b;
  }

  // What a checkpoint holds, each under its name.
  template <class Visit>
  static void for_each_field(const Visit& visit) {
    visit("begin", &ChunkContacts::begin), visit("end", &ChunkContacts::end), visit("dummy", &ChunkContacts::dummy);
    visit("blocks", &ChunkContacts::blocks), visit("first_wrapping", &ChunkContacts::first_wrapping);
    visit("pairs", &ChunkContacts::pairs);
    visit("near", &ChunkContacts::near), visit("far", &ChunkContacts::far), visit("beside", &ChunkContacts::beside);
    visit("inner", &ChunkContacts::inner), visit("middle", &ChunkContacts::middle);
    visit("near_closing", &ChunkContacts::near_closing), visit("far_closing", &ChunkContacts::far_closing);
    visit("solid_blocks", &ChunkContacts::solid_blocks);
    visit("slots", &ChunkContacts::slots);
  }

  size_t bytes() const {
    return blocks.capacity() * sizeof(blocks[0]) + (near.capacity() + far.capacity()) * sizeof(near[0]) +
           beside.capacity() * sizeof(beside[0]) + solid_blocks.capacity() * sizeof(solid_blocks[0]) +
           slots.capacity() * sizeof(slots[0]);
  }
};

}  // namespace scree
