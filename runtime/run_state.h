// What a run knows beside its particles: where in its stages it is, and what it has measured. All of it goes into
// checkpoints.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "runtime/case.h"
#include "runtime/mass_flow.h"

namespace scree {

struct StageRecord {
  std::string name, kind;
  double start = 0, end = 0;  // s
  uint64_t particles = 0;     // at the end

  template <class Visit>
  static void for_each_field(const Visit& visit) {
    visit("name", &StageRecord::name), visit("kind", &StageRecord::kind);
    visit("start", &StageRecord::start), visit("end", &StageRecord::end);
    visit("particles", &StageRecord::particles);
  }
};

struct RunState {
  std::string source;       // Case::source of the run's beginning
  uint64_t stage = 0;       // index of the stage that runs or comes next
  bool begun = false;       // it has its record, and its own values below are set
  uint64_t stage_step = 0;  // the engine's steps when it began
  struct Pouring {
    double next = 0, last_placed = 0;  // s since the stage began
    template <class Visit>
    static void for_each_field(const Visit& visit) {
      visit("next", &Pouring::next), visit("last_placed", &Pouring::last_placed);
    }
  } pouring;
  struct Draining {
    double present = 0, before = 0;         // kg, in the run and discharged when the stage began
    double last_mass = 0, last_change = 0;  // kg discharged when it last grew; s since the stage began
    template <class Visit>
    static void for_each_field(const Visit& visit) {
      visit("present", &Draining::present), visit("before", &Draining::before);
      visit("last_mass", &Draining::last_mass), visit("last_change", &Draining::last_change);
    }
  } draining;
  std::vector<StageRecord> records;
  std::vector<FlowSample> samples;  // the rows of mass_flow.csv
  std::vector<double> meter_rows;   // of meters.csv, one row after the other
  double wall_seconds = 0;          // of the processes that ran it before

  template <class Visit>
  static void for_each_field(const Visit& visit) {
    visit("source", &RunState::source), visit("stage", &RunState::stage), visit("begun", &RunState::begun);
    visit("stage_step", &RunState::stage_step), visit("pouring", &RunState::pouring);
    visit("draining", &RunState::draining), visit("records", &RunState::records);
    visit("samples", &RunState::samples), visit("meter_rows", &RunState::meter_rows);
    visit("wall_seconds", &RunState::wall_seconds);
  }
};

// Throws StateRefused (runtime/state_archive.h) if what a checkpoint brought is not where a run of this case can be.
void require_sound(const RunState& state, const Case& c);

}  // namespace scree
