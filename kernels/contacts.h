// Where contacts live: per chunk of consecutive particles, in blocks that the SIMD loops walk.
//
// A chunk owns the contacts of its particles. A pair inside a chunk is stored once; a pair across two chunks is stored
// in both, each time with the inside particle as i. No atomics, no reduction, and the bits do not depend on threads:
//
//      chunk A           chunk B          stored in A: (1,2) (2,5)    in B: (5,2) (5,6)
//    [ 1 . 2 ] ------- [ 5 . 6 ]
//
// Near pairs (within the outer skin, not the inner) wait in `near` and are promoted to blocks as they approach.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace scree {

inline constexpr int kBlock = 16;  // contacts in a block, whatever the lanes' width

// Padding lanes name the two dummy particles after the last real one; they never touch anything.
template <class Real>
struct alignas(64) PairBlock {
  uint32_t i[kBlock], j[kBlock];
  Real history[6][kBlock];  // tangential displacement x y z (m), rolling torque x y z (N m); zero when not touching
};

struct NearPair {
  uint32_t i, j;
};

// Sixteen particles, each with up to `slots` solid primitives near it. One block's slots hold one kind of skeleton
// each, in the order segments, quads, revolutions; padding names the kind's dummy primitive, far away.
struct SolidBlock {
  uint32_t i[kBlock];
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
  std::vector<PairBlock<Real>> blocks;
  uint32_t pairs = 0;  // active pairs; the last block is padded
  std::vector<NearPair> near;
  std::vector<SolidBlock> solid_blocks;
  std::vector<SolidSlot<Real>> slots;

  void clear() {
    blocks.clear(), near.clear(), solid_blocks.clear(), slots.clear();
    pairs = 0;
  }

  // Appends an active pair; history all zero.
  PairBlock<Real>& append(uint32_t i, uint32_t j, uint32_t dummy) {
    const uint32_t lane = pairs % kBlock;
    if (lane == 0) {
      PairBlock<Real>& b = blocks.emplace_back();
      for (int k = 0; k < kBlock; ++k) b.i[k] = dummy, b.j[k] = dummy + 1;
    }
    PairBlock<Real>& b = blocks.back();
    b.i[lane] = i, b.j[lane] = j;
    ++pairs;
    return b;
  }

  size_t bytes() const {
    return blocks.capacity() * sizeof(blocks[0]) + near.capacity() * sizeof(near[0]) +
           solid_blocks.capacity() * sizeof(solid_blocks[0]) + slots.capacity() * sizeof(slots[0]);
  }
};

}  // namespace scree
