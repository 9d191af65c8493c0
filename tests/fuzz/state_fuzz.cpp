// Arrays of the right names with any content and size are a state that the run can go on from, or are refused; nothing
// else may happen. (What is damaged on the disk never comes so far: seal_fuzz.cpp.)
//
// An input picks one of a real run's checkpoints and edits its arrays: byte 0 the checkpoint and who loads it, the
// whole run or an engine that then takes steps; then for each edit a byte for the array, one for what is done to it,
// two for where or how much, one for how many bytes follow, and these.
#include <cstdint>

#include <spdlog/sinks/null_sink.h>

#include "runtime/stages.h"
#include "tests/array_memory.h"
#include "tests/fuzz/small_run.h"

namespace scree::fuzz {
namespace {

constexpr int kSteps = 3;         // before and after walls are opened
constexpr size_t kMostEdits = 8;  // of one input

using Arrays = StoredArrays;

struct World {
  SmallRun run;
  RunOptions options;
  std::shared_ptr<spdlog::logger> log =
      std::make_shared<spdlog::logger>("fuzz", std::make_shared<spdlog::sinks::null_sink_mt>());
  std::vector<Arrays> states;  // one before lists were made, some with, one amid a pour

  World() {
    options.engine.brute_force_solid = true;  // Embree's trees take longer than all else
    options.out = run.folder.path();
    const size_t count = run.checkpoints.size(), kept = 12;
    for (size_t k = 0; k < kept; ++k) {
      RecordingSource source(run.checkpoints[k * (count - 1) / (kept - 1)]);
      StateReader in(source);
      Simulation(run.c, options, log).load(in);
      states.push_back(std::move(source.arrays));
    }
  }
};

const World& world() {
  static const World w;
  return w;
}

class Input {
 public:
  Input(const uint8_t* data, size_t size) : at_(data), end_(data + size) {}
  bool empty() const { return at_ == end_; }
  size_t byte() { return empty() ? 0 : *at_++; }
  size_t word() { return byte() | byte() << 8; }

 private:
  const uint8_t *at_, *end_;
};

void edit(Arrays& arrays, Input& in) {
  auto chosen = arrays.begin();
  std::advance(chosen, in.byte() % arrays.size());
  std::vector<char>& bytes = chosen->second.bytes;
  const size_t what = in.byte() % 8, place = in.word(), length = in.byte() % 65;
  if (what == 0) return void(arrays.erase(chosen));
  if (what == 1) return bytes.resize(place * chosen->second.type.size);
  const size_t begin = what < 4 ? place : place * chosen->second.type.size;  // byte, or element
  for (size_t k = 0; k < length; ++k)
    if (const char c = static_cast<char>(in.byte()); begin + k < bytes.size()) bytes[begin + k] = c;
}

void load_run(const World& world, const Arrays& arrays) {
  MemorySource source(arrays);
  StateReader in(source);
  Simulation(world.run.c, world.options, world.log).load(in);
}

// Goes through all that reads the lists: steps, the histories' way across a rebuild, sums.
void go_on(const World& world, const Arrays& arrays) {
  const auto engine = make_engine(world.run.c, world.options.engine);
  MemorySource source(arrays);
  StateReader in(source);
  engine->load(in);
  try {
    for (int k = 0; k < kSteps; ++k) engine->step();
    engine->open_walls({0});
    for (int k = 0; k < kSteps; ++k) engine->step();
  } catch (const RunError&) {
  }
  engine->touching_pairs();
  engine->sum([](const ParticleState& p) { return p.mass; });
}

}  // namespace
}  // namespace scree::fuzz

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace scree;
  const fuzz::World& world = fuzz::world();
  fuzz::Input input(data, size);
  const size_t first = input.byte(), states = world.states.size();
  fuzz::Arrays arrays = world.states[first % states];
  for (size_t k = 0; k < fuzz::kMostEdits && !input.empty(); ++k) fuzz::edit(arrays, input);
  try {
    if (first / states % 2 == 0)
      fuzz::load_run(world, arrays);
    else
      fuzz::go_on(world, arrays);
  } catch (const Hdf5Error&) {
  } catch (const StateRefused&) {
  } catch (const CheckpointRefused&) {
  }
  return 0;
}
