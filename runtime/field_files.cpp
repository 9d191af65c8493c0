#include "runtime/field_files.h"

#include <chrono>
#include <memory>
#include <utility>

#include "runtime/particle_fields.h"
#include "runtime/solid_mesh.h"
#include "runtime/timer.h"

namespace scree {

namespace {

constexpr size_t kFewParticles = 200'000, kManyParticles = 4'000'000;

// Few particles' frame is written while the next is packed, by one of the loop's threads: a thread more would take a
// core from one of them now and then, and all others would wait for what that one has begun.
std::vector<PackedArray> packed_with_writing(const Case& c, const Engine& engine, Background& writer) {
  const ParticleSnapshot snapshot(c, engine, c.output.fields.write);
  return packed_particles(snapshot, [&] { writer.run_patient(); });
}

// Of many particles one frame at a time is in memory.
std::vector<PackedArray> packed_after_writing(const Case& c, const Engine& engine, Background& writer) {
  writer.finish();
  return packed_particles(c, engine, c.output.fields.write);
}

}  // namespace

bool writes_fields(const FieldSettings& s) {
  return s.moments.interval > 0 || !s.moments.times.empty() || s.moments.stage_ends;
}

FieldFiles::FieldFiles(const Case& c, const std::filesystem::path& out, double dt, std::chrono::milliseconds patience)
    : schedule_(c.output.fields.moments, dt),
      patience_(patience),
      particles_(out / "fields", "particles", VtkHdfType::unstructured_grid, background_),
      solid_(out / "fields", "solid", VtkHdfType::unstructured_grid, background_) {}

// The writer works on what goes next.
FieldFiles::~FieldFiles() {
  try {
    background_.finish();
  } catch (const RunError&) {  // told by finish(), or the run has failed for another reason
  }
}

// A stage may end at a step that has its frame. That one stays unless there is more to show: contacts, or particles
// that went in since and have none yet, while the frame had none either.
bool FieldFiles::has_frame_of_now(const Engine& engine) const {
  const auto& frames = particles_.frames();
  if (frames.empty() || frames.back().step != engine.counters().steps) return false;
  const bool same = newest_.inserted == engine.counters().inserted;
  return engine.knows_contacts() ? newest_.contacts_known && same : newest_.contacts_known || same;
}

void FieldFiles::look(const RunView& run) {
  const Timer timer(seconds_);
  const Engine& engine = run.engine;
  const uint64_t step = engine.counters().steps;
  const FieldSettings& settings = run.c.output.fields;
  if (settings.solid && run.solid.primitives.size() != newest_.solid_primitives) {
    solid_.write(step, engine.time(), [mesh = std::make_shared<SolidMesh>(mesh_of(run.solid))](VtkHdfFile& file) {
      write_mesh(file, *mesh);
    });
    newest_.solid_primitives = run.solid.primitives.size();
  }
  if (has_frame_of_now(engine)) return;
  // Packed here, on all threads: beside the run, one thread of the loops would lose its core to it, and all wait.
  const bool few = engine.count() < kFewParticles;
  std::vector<PackedArray> frame = (few ? packed_with_writing : packed_after_writing)(run.c, engine, background_);
  const auto patience = few ? patience_ : std::chrono::milliseconds{0};
  particles_.write(
      step, engine.time(),
      [frame = std::move(frame)](VtkHdfFile& file) {
        for (const PackedArray& array : frame) file.array(array);
      },
      patience);
  newest_.inserted = engine.counters().inserted, newest_.contacts_known = engine.knows_contacts();
  // A picture of this moment may come next: of ten million particles one of the two is enough to hold.
  if (engine.count() >= kManyParticles) background_.finish();
}

void FieldFiles::finish(const RunView&) {
  const Timer timer(seconds_);
  particles_.prepare(), solid_.prepare();
  particles_.settle(), solid_.settle();
}

void FieldFiles::save(StateWriter& out, const std::string& at) const {
  particles_.settle(), solid_.settle();
  particles_.save(out, at + "/particles"), solid_.save(out, at + "/solid");
  out.save(at + "/newest", newest_);
}

void FieldFiles::load(StateReader& in, const std::string& at) {
  particles_.load(in, at + "/particles"), solid_.load(in, at + "/solid");
  in.load(at + "/newest", newest_);
}

nlohmann::json FieldFiles::summary() const {
  return {{"frames", particles_.frames().size()},
          {"bytes_written", particles_.bytes() + solid_.bytes()},
          {"seconds_in_run", seconds_},
          {"seconds_of_writing", particles_.seconds() + solid_.seconds()}};
}

}  // namespace scree
