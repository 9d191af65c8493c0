// Contact histories on their way across a rebuild: by old particle index, keyed by partner.
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/contacts.h"

namespace scree {

template <class Real>
struct HistoryEntry {
  uint32_t partner;  // old particle index, or the solid primitive's identity
  Real value[6];
};

// The live contacts of one chunk's particles, gathered by particle.
template <class Real>
struct ChunkHistory {
  std::vector<uint32_t> first;  // chunk size + 1
  std::vector<HistoryEntry<Real>> entries;

  template <class Visit>
  static void for_each_field(const Visit& visit) {
    visit("first", &ChunkHistory::first);
    visit("entries", &ChunkHistory::entries);
  }

  // Fills from contacts listed twice in the same order: list(visit) calls visit(local particle, partner, history,
  // stride).
  template <class List>
  void gather(uint32_t size, const List& list) {
    first.assign(size + 1, 0);
    list([&](uint32_t local, uint32_t, const Real*) { ++first[local + 1]; });
    for (uint32_t k = 0; k < size; ++k) first[k + 1] += first[k];
    entries.resize(first[size]);
    std::vector<uint32_t> next(first.begin(), first.end() - 1);
    list([&](uint32_t local, uint32_t partner, const Real* history) {
      HistoryEntry<Real>& e = entries[next[local]++];
      e.partner = partner;
      for (int k = 0; k < 6; ++k) e.value[k] = history[k * kBlock];
    });
  }

  const HistoryEntry<Real>* find(uint32_t local, uint32_t partner) const {
    for (uint32_t k = first[local]; k < first[local + 1]; ++k)
      if (entries[k].partner == partner) return &entries[k];
    return nullptr;
  }
};

template <class Real>
struct HistoryTable {
  uint32_t chunk_size = 1, count = 0;  // of the old order
  std::vector<ChunkHistory<Real>> pairs, solids;

  template <class Visit>
  static void for_each_field(const Visit& visit) {
    visit("chunk_size", &HistoryTable::chunk_size);
    visit("count", &HistoryTable::count);
    visit("pairs", &HistoryTable::pairs);
    visit("solids", &HistoryTable::solids);
  }

  size_t bytes() const {  // held, in use or not
    size_t total = (pairs.capacity() + solids.capacity()) * sizeof(ChunkHistory<Real>);
    for (const auto* chunks : {&pairs, &solids})
      for (const ChunkHistory<Real>& c : *chunks)
        total += c.first.capacity() * sizeof(uint32_t) + c.entries.capacity() * sizeof(HistoryEntry<Real>);
    return total;
  }

  // What old particle a's pairs had.
  class Pairs {
   public:
    Pairs(const HistoryTable& table, uint32_t a) : table_(table), a_(a) {
      if (a >= table.count) return;
      own_ = &table.pairs[a / table.chunk_size];
      begin_ = a / table.chunk_size * table.chunk_size;
    }
    // Copies the history of a and b, as seen from a, to a lane of a block. False if there is none.
    bool copy(uint32_t b, Real* to) const {
      if (!own_ || b >= table_.count) return false;
      const bool at_b = b < a_ && b >= begin_;  // inside a chunk a pair is stored once, at the lower index
      const HistoryEntry<Real>* e = at_b ? own_->find(b - begin_, a_) : own_->find(a_ - begin_, b);
      if (!e) return false;
      const Real sign = at_b ? Real(-1) : Real(1);
      for (int k = 0; k < 6; ++k) to[k * kBlock] = sign * e->value[k];
      return true;
    }

   private:
    const HistoryTable& table_;
    uint32_t a_, begin_ = 0;
    const ChunkHistory<Real>* own_ = nullptr;  // null: a is new
  };
  bool copy_solid(uint32_t a, uint32_t primitive, Real* to) const {
    if (a >= count) return false;
    const HistoryEntry<Real>* e = solids[a / chunk_size].find(a % chunk_size, primitive);
    if (!e) return false;
    for (int k = 0; k < 6; ++k) to[k * kBlock] = e->value[k];
    return true;
  }
};

// Live contacts of a chunk, for ChunkHistory::gather: pairs with a history that is not zero.
template <class Real>
void list_live_pairs(const ChunkContacts<Real>& contacts, const auto& visit) {
  for (uint32_t k = 0; k < contacts.pairs; ++k) {
    const PairBlock<Real>& b = contacts.blocks[k / kBlock];
    const Real* h = b.history[0] + k % kBlock;
    Real any = 0;
    for (int c = 0; c < 6; ++c) any += h[c * kBlock] != 0;
    if (any != 0) visit(b.i[k % kBlock], b.j[k % kBlock], h);
  }
}

// identity(slot kind 0..2, row) is the primitive's index in the case's list, the same for its periodic images.
template <class Real>
void list_live_solids(const ChunkContacts<Real>& contacts, const auto& identity, const auto& visit) {
  for (const SolidBlock& block : contacts.solid_blocks)
    for (uint32_t s = 0; s < block.slots(); ++s) {
      const SolidSlot<Real>& slot = contacts.slots[block.first_slot + s];
      const int kind = s < block.segments ? 0 : s < uint32_t{block.segments} + block.quads ? 1 : 2;
      for (int lane = 0; lane < kBlock; ++lane)
        if (slot.live >> lane & 1u) visit(block.i[lane], identity(kind, slot.primitive[lane]), slot.history[0] + lane);
    }
}

}  // namespace scree
