// DIR/fields: the particles, fibres and walls of a run at chosen moments, for ParaView.
//
//   particles.vtkhdf.series   opens all frames with their times; particles_STEP.vtkhdf is one: the fields are in
//                             runtime/particle_fields.h
//   solid.vtkhdf.series       fibres and walls as a surface (runtime/solid_mesh.h), a frame whenever walls were opened
//
// Both lists are there as *.hdf.series, too (runtime/frame_files.h).
//
// look() packs the particles on all threads and goes on. A frame of few particles is written while the next is packed,
// by one of the threads, or half a second later by a thread beside the run; of more at once by that thread, which
// writes the solid, too. Of those one frame is in memory at a time: if the one before is not written yet, look() waits,
// and of millions it waits for its own. Its making takes kFieldBytesPerParticle, what waits to be written
// kPackedBytesPerParticle; of few particles all columns are there at once, and two frames may wait.
#pragma once

#include "runtime/frame_files.h"
#include "runtime/observer.h"

namespace scree {

inline constexpr double kFieldBytesPerParticle = 100, kPackedBytesPerParticle = 75;

bool writes_fields(const FieldSettings& settings);

class FieldFiles final : public Observer {
 public:
  // `patience`: how long a frame of few particles waits for the next one's packing.
  FieldFiles(const Case& c, const std::filesystem::path& out, double dt,
             std::chrono::milliseconds patience = std::chrono::milliseconds{500});
  ~FieldFiles() override;

  std::string name() const override { return "fields"; }
  const Schedule& schedule() const override { return schedule_; }
  void look(const RunView& run) override;
  void finish(const RunView& run) override;
  void save(StateWriter& out, const std::string& at) const override;
  void load(StateReader& in, const std::string& at) override;
  nlohmann::json summary() const override;

 private:
  // What the newest frame shows.
  struct Newest {
    uint64_t inserted = 0;          // particles by then
    uint64_t solid_primitives = 0;  // of the newest frame of the solid; 0: there is none yet
    bool contacts_known = false;
    template <class Visit>
    static void for_each_field(const Visit& visit) {
      visit("inserted", &Newest::inserted), visit("solid_primitives", &Newest::solid_primitives);
      visit("contacts_known", &Newest::contacts_known);
    }
  };
  bool has_frame_of_now(const Engine& engine) const;

  Schedule schedule_;
  std::chrono::milliseconds patience_;
  mutable Background background_;
  mutable FrameFiles particles_, solid_;
  Newest newest_;
  double seconds_ = 0;  // of the run
};

}  // namespace scree
