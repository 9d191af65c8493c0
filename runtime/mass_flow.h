// Mass that has passed an outlet, its rate, and the steady part of a discharge curve.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runtime/case.h"
#include "runtime/engine.h"

namespace scree {

// Everything beyond the outlet's plane counts as discharged, whether it is still in the run or was taken out.
bool beyond(const Outlet& outlet, const ParticleState& p, double distance = 0);

struct FlowSample {
  double time;                     // s since the run began
  std::vector<double> discharged;  // kg, per outlet
  double total() const;

  template <class Visit>
  static void for_each_field(const Visit& visit) {
    visit("time", &FlowSample::time), visit("discharged", &FlowSample::discharged);
  }
};

struct SteadyFlow {
  double rate = 0, standard_error = 0;  // kg/s
  double from = 0, to = 0;              // s, the window
  int bins = 0;                         // independent stretches that the standard error comes from
};

// The longest window in which the flow neither trends nor wanders: each fifth of it flows like the whole, within 8 %.
// Of equally long ones the one with the highest rate. What is left of a surge at its beginning is cut off where that
// makes the mean most certain, at most half of it (MSER: White, Simulation 69 (1997) 323). Rate: slope between the
// window's ends. Standard error: from the scatter of the means of eight stretches. Nothing if there is no such window
// of at least a fifth of [from, to] and of at least `shortest` seconds: what a surge may last.
std::optional<SteadyFlow> find_steady_flow(const std::vector<FlowSample>& samples, double from, double to,
                                           double shortest);

// The same quantities for a window that the user named.
std::optional<SteadyFlow> steady_flow_in(const std::vector<FlowSample>& samples, double from, double to);

}  // namespace scree
