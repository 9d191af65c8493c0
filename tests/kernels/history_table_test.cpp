// Histories on their way from old lists to new ones.
#include "kernels/history_table.h"

#include <gtest/gtest.h>

#include <array>

#include "kernels/array.h"

namespace scree {
namespace {

using Values = std::array<float, 6>;

void put(PairBlock<float>& block, uint32_t lane, const Values& v) {
  for (int k = 0; k < 6; ++k) block.history[k][lane] = v[k];
}
Values lane_of(const PairBlock<float>& block, int lane) {
  Values v;
  for (int k = 0; k < 6; ++k) v[k] = block.history[k][lane];
  return v;
}
Values values(float from) { return {from, from + 1, from + 2, from + 3, from + 4, from + 5}; }
Values negated(Values v) {
  for (float& x : v) x = -x;
  return v;
}

// Ten particles in chunks of four: [0 1 2 3] [4 5 6 7] [8 9].
class Histories : public ::testing::Test {
 protected:
  static constexpr uint32_t kCount = 10, kSize = 4;
  std::array<ChunkContacts<float>, 3> contacts_;
  HistoryTable<float> table_;

  Histories() {
    for (uint32_t c = 0; c < 3; ++c) contacts_[c].clear(c * kSize, std::min(kCount, (c + 1) * kSize), kCount);
  }
  static void add_pair(ChunkContacts<float>& c, uint32_t i, uint32_t j, const Values& v) {
    PairBlock<float>& block = c.append(i, j);
    put(block, (c.pairs - 1) % kBlock, v);
  }
  // As the step stores it: inside a chunk once, across two chunks in both, seen from each.
  void touch(uint32_t i, uint32_t j, const Values& v) {
    const auto add = [&](uint32_t a, uint32_t b, const Values& seen) { add_pair(contacts_[a / kSize], a, b, seen); };
    add(i, j, v);
    if (i / kSize != j / kSize) add(j, i, negated(v));
  }
  void gather() {
    table_.chunk_size = kSize, table_.count = kCount;
    table_.pairs.resize(3), table_.solids.resize(3);
    for (uint32_t c = 0; c < 3; ++c) {
      const uint32_t size = contacts_[c].end - contacts_[c].begin;
      table_.pairs[c].gather(size, [&](const auto& visit) { list_live_pairs(contacts_[c], visit); });
      const auto identity = [](int kind, uint32_t row) { return 1000 * static_cast<uint32_t>(kind) + row; };
      table_.solids[c].gather(size, [&](const auto& visit) { list_live_solids(contacts_[c], identity, visit); });
    }
  }
  // What a rebuilt pair (a, b) finds, if anything.
  bool finds(uint32_t a, uint32_t b, Values& v) const {
    PairBlock<float> block{};
    const bool found = HistoryTable<float>::Pairs(table_, a).copy(b, block.history[0] + 5);
    v = lane_of(block, 5);
    for (int lane = 0; lane < kBlock; ++lane)
      EXPECT_TRUE(lane == 5 || lane_of(block, lane) == Values{}) << "another lane was written";
    return found;
  }
};

TEST_F(Histories, InsideAChunkAreFoundFromBothSidesWithTheirSign) {
  touch(1, 3, values(1));
  touch(1, 2, values(10));
  gather();
  Values v;
  ASSERT_TRUE(finds(1, 3, v));
  EXPECT_EQ(v, values(1));
  ASSERT_TRUE(finds(3, 1, v));
  EXPECT_EQ(v, negated(values(1)));
  ASSERT_TRUE(finds(2, 1, v));
  EXPECT_EQ(v, negated(values(10)));
}

TEST_F(Histories, AcrossChunksAreFoundFromBothSidesWithTheirSign) {
  touch(2, 8, values(1));
  touch(3, 4, values(20));
  gather();
  Values v;
  ASSERT_TRUE(finds(2, 8, v));
  EXPECT_EQ(v, values(1));
  ASSERT_TRUE(finds(8, 2, v));
  EXPECT_EQ(v, negated(values(1)));
  ASSERT_TRUE(finds(4, 3, v));
  EXPECT_EQ(v, negated(values(20)));
}

TEST_F(Histories, ThatDoNotExistLeaveTheLaneAlone) {
  touch(1, 3, values(1));
  touch(0, 2, Values{});  // listed, not touching
  gather();
  Values v;
  EXPECT_FALSE(finds(0, 1, v));
  EXPECT_EQ(v, Values{});
  EXPECT_FALSE(finds(0, 2, v));
  EXPECT_FALSE(finds(4, 5, v));
  EXPECT_FALSE(finds(1, 10, v));  // a particle that was not there before
  EXPECT_FALSE(finds(0xffffffffu, 1, v));
}

TEST_F(Histories, OfManyContactsOfOneParticleAreKeptApart) {
  for (uint32_t j = 1; j < kCount; ++j) touch(0, j, values(100.0f * static_cast<float>(j)));
  for (uint32_t j = 1; j < 4; ++j) touch(j, 9, values(1000.0f * static_cast<float>(j)));
  gather();
  Values v;
  for (uint32_t j = 1; j < kCount; ++j) {
    ASSERT_TRUE(finds(j, 0, v));
    EXPECT_EQ(v, negated(values(100.0f * static_cast<float>(j))));
  }
  for (uint32_t j = 1; j < 4; ++j) {
    ASSERT_TRUE(finds(9, j, v));
    EXPECT_EQ(v, negated(values(1000.0f * static_cast<float>(j))));
  }
}

TEST_F(Histories, OfMoreThanOneBlockAreAllGathered) {
  ChunkContacts<float>& c = contacts_[0];
  for (uint32_t k = 0; k < 40; ++k) add_pair(c, k % 4, 100 + k, values(static_cast<float>(1 + k)));
  EXPECT_EQ(c.blocks.size(), 3u);
  gather();
  for (uint32_t k = 0; k < 40; ++k) {
    const auto* e = table_.pairs[0].find(k % 4, 100 + k);
    ASSERT_NE(e, nullptr);
    EXPECT_EQ(e->value[5], static_cast<float>(6 + k));
  }
}

// Live lanes only, under the primitive's identity, which its periodic images share.
TEST_F(Histories, OfTheSolidAreFoundByTheIdentityOfThePrimitive) {
  ChunkContacts<float>& c = contacts_[1];
  SolidBlock block{};
  for (int lane = 0; lane < kBlock; ++lane) block.i[lane] = static_cast<uint16_t>(lane % 4);
  block.segments = 1, block.quads = 1, block.revolutions = 1;
  c.solid_blocks.push_back(block);
  for (uint32_t s = 0; s < 3; ++s) {
    SolidSlot<float>& slot = c.slots.emplace_back();
    for (int lane = 0; lane < kBlock; ++lane) {
      slot.primitive[lane] = 7 + s;
      for (int k = 0; k < 6; ++k)
        slot.history[k][lane] =
            100.0f * static_cast<float>(s) + 10.0f * static_cast<float>(lane) + static_cast<float>(k);
    }
    slot.live = s == 1 ? 0b0010u : 0b0001u;
  }
  gather();
  PairBlock<float> to{};
  ASSERT_TRUE(table_.copy_solid(4, 7, to.history[0] + 2));
  EXPECT_EQ(lane_of(to, 2), values(0));
  ASSERT_TRUE(table_.copy_solid(5, 1008, to.history[0] + 3));
  EXPECT_EQ(lane_of(to, 3), (Values{110, 111, 112, 113, 114, 115}));
  ASSERT_TRUE(table_.copy_solid(4, 2009, to.history[0] + 4));
  EXPECT_EQ(lane_of(to, 4), (Values{200, 201, 202, 203, 204, 205}));
  EXPECT_FALSE(table_.copy_solid(4, 1008, to.history[0] + 6));  // that lane was not live
  EXPECT_FALSE(table_.copy_solid(6, 7, to.history[0] + 6));
  EXPECT_FALSE(table_.copy_solid(10, 7, to.history[0] + 6));
}

TEST(Array, BeginsOnCacheLinesWithTheStaggerAskedFor) {
  struct Record {
    double x[8];
  };
  for (const size_t stagger : {0, 64, 33 * 64, 4096}) {
    Array<Record> a;
    a.allocate(1001, stagger);
    EXPECT_EQ(reinterpret_cast<uintptr_t>(a.data()) % 4096, stagger % 4096);
    EXPECT_EQ(a.capacity(), 1001u);
    a[1000].x[7] = 3;  // the last byte is ours
    EXPECT_EQ(a.data()[1000].x[7], 3);
  }
}

TEST(Array, SwapsWithoutCopying) {
  Array<int> a, b;
  a.allocate(10), b.allocate(20, 64);
  a[3] = 1, b[3] = 2;
  const int *pa = a.data(), *pb = b.data();
  a.swap(b);
  EXPECT_EQ(a.data(), pb);
  EXPECT_EQ(b.data(), pa);
  EXPECT_EQ(a.capacity(), 20u);
  EXPECT_EQ(b[3], 1);
}

TEST(HistoryTable, BytesAreWhatItHoldsInUseOrNot) {
  HistoryTable<float> table;
  EXPECT_EQ(table.bytes(), 0u);
  table.pairs.resize(2), table.solids.resize(1);
  const size_t empty = table.bytes();
  table.pairs[1].entries.reserve(100), table.solids[0].first.reserve(50);
  EXPECT_EQ(table.bytes() - empty, 100 * sizeof(HistoryEntry<float>) + 50 * sizeof(uint32_t));
  table.pairs[1].entries.resize(60), table.pairs[1].entries.clear();
  EXPECT_EQ(table.bytes() - empty, 100 * sizeof(HistoryEntry<float>) + 50 * sizeof(uint32_t));
}

}  // namespace
}  // namespace scree
