// Touch maps: on every fibre and plane wall, cell by cell, how much of the time grains touch it, how many, how hard,
// and how much they rub: DIR/touch/. Seen at intervals: a look at the solid's contacts every some tens of steps.
//
// Only exposed surface counts: what lies inside another fibre, beyond a wall as seen from the lattice's middle, or
// outside a face is masked (runtime/touch_surface.h). A cell that no grain touched in any look is dead.
#pragma once

#include "runtime/observer.h"
#include "runtime/touch_surface.h"

namespace scree {

// Of one cell, over all looks.
struct TouchSums {
  uint64_t touched = 0;   // looks in which a grain touched it
  uint64_t contacts = 0;  // grains that touched it, summed over looks
  double force = 0;       // N, normal, summed over contacts
  double rubbing = 0;  // W, -(tangential force) . slip, summed over contacts: one that sticks gives back what it took

  template <class Visit>
  static void for_each_field(const Visit& visit) {
    visit("touched", &TouchSums::touched), visit("contacts", &TouchSums::contacts);
    visit("force", &TouchSums::force), visit("rubbing", &TouchSums::rubbing);
  }
};

struct TouchRecord {
  uint64_t looks = 0;
  uint64_t elsewhere = 0;   // contacts with mapped primitives that fell on no cell: fibres' round ends
  double from = 0, to = 0;  // s, first and last look
  double seconds = 0;       // wall-clock, of all looks
  uint64_t last_step = Schedule::kNever;
  std::vector<TouchSums> cells;

  template <class Visit>
  static void for_each_field(const Visit& visit) {
    visit("looks", &TouchRecord::looks), visit("elsewhere", &TouchRecord::elsewhere);
    visit("from", &TouchRecord::from), visit("to", &TouchRecord::to), visit("seconds", &TouchRecord::seconds);
    visit("last_step", &TouchRecord::last_step), visit("cells", &TouchRecord::cells);
  }
};

// Adds one look at these contacts.
void add_touches(const TouchSurface& surface, std::span<const ContactState> contacts, TouchRecord& record);

class TouchMaps final : public Observer {
 public:
  TouchMaps(const Case& c, double dt);

  std::string name() const override { return "touch"; }
  const Schedule& schedule() const override { return schedule_; }
  void look(const RunView& run) override;
  void finish(const RunView& run) override;
  void save(StateWriter& out, const std::string& at) const override { out.save(at, record_); }
  void load(StateReader& in, const std::string& at) override { in.load(at, record_); }
  nlohmann::json summary() const override { return summary_; }

  const TouchSurface& surface() const { return surface_; }
  const TouchRecord& record() const { return record_; }

 private:
  During during_;
  Schedule schedule_;
  TouchSurface surface_;
  TouchRecord record_;
  nlohmann::json summary_;
};

}  // namespace scree
