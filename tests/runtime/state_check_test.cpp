// A checkpoint whose bytes are whole but whose values are no state of the case is refused with a reason, by whoever
// would use the value: never loaded, never a crash. (Found by tests/fuzz/state_fuzz.cpp, or by reading.)
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "kernels/contacts.h"
#include "kernels/particle.h"
#include "runtime/checkpoint.h"
#include "runtime/run_state.h"
#include "runtime/state_archive.h"
#include "tests/array_memory.h"
#include "tests/oracle/beds.h"
#include "tests/runtime/case_text.h"

namespace scree {
namespace {

using testing::Folder;

const LooseBed kBed{6, 6, 4};

std::unique_ptr<Engine> bed_engine() { return make_engine(bed_case(kBed)); }

// The arrays of a bed on its floor, its lists valid or their histories waiting.
StoredArrays saved(bool with_lists) {
  const auto engine = bed_engine();
  engine->insert(kBed.particles({0, 0, 1e-6}, 1));
  run_steps(*engine, 1500);
  if (!with_lists) engine->open_walls({7});  // none of that number
  const Folder folder;
  const std::string path = folder.path("state.h5");
  Hdf5Writer file(path);
  StateWriter out(file);
  engine->save(out);
  file.close();
  RecordingSource source(path);
  StateReader in(source);
  bed_engine()->load(in);
  return source.arrays;
}

// What loading says; empty: nothing against it.
std::string refusal(const StoredArrays& arrays) {
  MemorySource source(arrays);
  StateReader in(source);
  try {
    bed_engine()->load(in);
  } catch (const StateRefused& e) {
    return e.what();
  } catch (const Hdf5Error& e) {
    return e.what();
  }
  return "";
}

// A copy of one element to be changed, put back at the end of the statement.
template <class T>
class Element {
 public:
  Element(StoredArrays& arrays, const std::string& name, size_t at = 0) : bytes_(arrays.at("engine/" + name).bytes) {
    at_ = at * sizeof(T);
    if (at_ + sizeof(T) > bytes_.size()) throw std::out_of_range(name + " is empty: the edit edits nothing");
    std::memcpy(static_cast<void*>(&value_), bytes_.data() + at_, sizeof(T));
  }
  ~Element() { std::memcpy(bytes_.data() + at_, &value_, sizeof(T)); }
  T& operator*() { return value_; }
  T* operator->() { return &value_; }

 private:
  std::vector<char>& bytes_;
  size_t at_;
  T value_;
};

struct Edit {
  const char* what;
  bool with_lists;
  std::function<void(StoredArrays&)> edit;
  const char* reason;
};

using Record = Particle<float>;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

const std::vector<Edit>& edits() {
  static const std::vector<Edit> all = {
      {"more particles", true, [](auto& a) { ++*Element<uint32_t>(a, "count"); }, "number of its particles"},
      {"4e9 particles", true, [](auto& a) { *Element<uint32_t>(a, "count") = 0xffffffff; }, "number of its particles"},
      {"no chunks", true, [](auto& a) { *Element<uint32_t>(a, "chunk_size") = 0; }, "chunks"},
      {"huge chunks", true, [](auto& a) { *Element<uint32_t>(a, "chunk_size") = 1 << 20; }, "chunks"},
      {"NaN skin", true, [](auto& a) { *Element<double>(a, "skin") = kNan; }, "not a number"},
      {"negative way", true, [](auto& a) { *Element<double>(a, "travel") = -1; }, "negative"},
      {"as large as the period", false, [](auto& a) { *Element<double>(a, "max_radius") = 1; }, "periodic"},
      {"half true", true, [](auto& a) { *Element<uint8_t>(a, "lists_valid") = 2; }, "neither true nor false"},
      {"another wall", true, [](auto& a) { *Element<uint32_t>(a, "solid_identity") = 1; }, "fibres and walls"},
      {"NaN position", true, [](auto& a) { Element<Record>(a, "particles", 3)->y = kNan; }, "not a number"},
      {"infinite speed", false, [](auto& a) { Element<Record>(a, "particles")->vx = INFINITY; }, "not a number"},
      {"no radius", true, [](auto& a) { Element<Record>(a, "particles")->radius = 0; }, "radius"},
      {"another kind", false, [](auto& a) { Element<Record>(a, "particles")->tag |= uint64_t{1} << 56; }, "kind"},
      {"a number too large", true, [](auto& a) { Element<Record>(a, "particles")->tag += 100000; }, "none was given"},
      {"fewer went in", true, [](auto& a) { *Element<uint64_t>(a, "counters/inserted") = 5; }, "more particles have"},
      {"weightless", true, [](auto& a) { Element<Record>(a, "particles")->inverse_mass = -1; }, "mass"},
      {"pair of none", true, [](auto& a) { Element<PairBlock<float>>(a, "contacts/blocks")->j[0] = 100000; }, "lists"},
      {"pair beyond the chunk", true, [](auto& a) { Element<PairBlock<float>>(a, "contacts/blocks")->i[1] = 60000; },
       "lists"},
      {"force to another row", true, [](auto& a) { Element<PairBlock<float>>(a, "contacts/blocks")->row[0] ^= 1; },
       "lists"},
      {"more pairs than blocks", true, [](auto& a) { *Element<uint32_t>(a, "contacts/pairs") += 1000; }, "lists"},
      {"near none", true, [](auto& a) { Element<WaitingPair>(a, "contacts/near")->j = 100000; }, "lists"},
      {"far none", true, [](auto& a) { Element<WaitingPair>(a, "contacts/far")->j = 100000; }, "lists"},
      {"other chunk", true, [](auto& a) { ++*Element<uint32_t>(a, "contacts/begin"); }, "lists"},
      {"slots of none", true, [](auto& a) { Element<SolidBlock>(a, "contacts/solid_blocks")->first_slot = 100000; },
       "lists"},
      {"too many slots", true, [](auto& a) { Element<SolidBlock>(a, "contacts/solid_blocks")->segments = 255; },
       "lists"},
      {"wall of none", true, [](auto& a) { Element<SolidSlot<float>>(a, "contacts/slots")->primitive[0] = 100000; },
       "lists"},
      {"a chunk less", true, [](auto& a) { a.at("engine/contacts/dummy").bytes.clear(); }, "lists"},
      {"endless list", true, [](auto& a) { *Element<uint64_t>(a, "contacts/blocks_sizes") = ~uint64_t{0}; },
       "too short"},
      {"histories of others", false, [](auto& a) { *Element<uint32_t>(a, "history/count") = 100000; }, "histories"},
      {"histories backwards", false, [](auto& a) { *Element<uint32_t>(a, "history/pairs/first", 1) = 100000; },
       "histories"},
      {"no history chunks", false, [](auto& a) { *Element<uint32_t>(a, "history/chunk_size") = 0; }, "histories"},
      {"array missing", true, [](auto& a) { a.erase("engine/skin"); }, "not there"},
  };
  return all;
}

TEST(StateCheck, WhatWasSavedIsSound) {
  for (const bool with_lists : {true, false}) EXPECT_EQ(refusal(saved(with_lists)), "");
}

TEST(StateCheck, WhatIsNoStateIsRefusedWithAReason) {
  const StoredArrays good[] = {saved(false), saved(true)};
  for (const Edit& e : edits()) {
    SCOPED_TRACE(e.what);
    StoredArrays arrays = good[e.with_lists];
    e.edit(arrays);
    EXPECT_NE(refusal(arrays).find(e.reason), std::string::npos) << refusal(arrays);
  }
}

// ---- whose it is

TEST(StateCheck, ACheckpointWhoseCaseIsNoCaseIsRefused) {
  Case c;
  c.understood = "seed = 1\n";
  EXPECT_NO_THROW(check_head(head_of(c), c));
  CheckpointHead head = head_of(c);
  for (const auto& [text, reason] : {std::pair("seed = 2\n", "another case"), {"ti+tle", "cannot be read"}}) {
    head.case_text = text;
    try {
      check_head(head, c);
      ADD_FAILURE() << text;
    } catch (const CheckpointRefused& e) {
      EXPECT_NE(std::string(e.what()).find(reason), std::string::npos) << e.what();
    }
  }
}

// ---- where the run is

std::string refusal(const RunState& state, const Case& c) {
  try {
    require_sound(state, c);
  } catch (const StateRefused& e) {
    return e.what();
  }
  return "";
}

TEST(StateCheck, ARunIsInAStageOfItsCase) {
  Case c;
  c.stages.resize(2);
  c.outlets.resize(1);
  RunState state;
  EXPECT_EQ(refusal(state, c), "");
  state.begun = true, state.records.resize(1);
  state.samples = {{0, {0.0}}, {1e-3, {2.0}}};
  EXPECT_EQ(refusal(state, c), "");
  const auto expect_refused = [&](const auto& edit, const char* reason) {
    RunState bad = state;
    edit(bad);
    EXPECT_NE(refusal(bad, c).find(reason), std::string::npos) << refusal(bad, c);
  };
  expect_refused([](RunState& s) { s.stage = 2; }, "a stage that the case does not have");
  expect_refused([](RunState& s) { s.stage = ~uint64_t{0}; }, "a stage that the case does not have");
  expect_refused([](RunState& s) { s.records.clear(); }, "not counted right");
  expect_refused([](RunState& s) { s.samples[1].time = 0; }, "out of order");
  expect_refused([](RunState& s) { s.samples[1].time = kNan; }, "out of order");
  expect_refused([](RunState& s) { s.samples[1].discharged = {}; }, "out of order");
  expect_refused([](RunState& s) { s.meter_rows = {1}; }, "torn");
}

}  // namespace
}  // namespace scree
