#include "runtime/mass_flow.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace scree {

namespace {

constexpr int kBins = 40;  // of the stretch that is searched, and of the window in it
constexpr int kFewestBins = kBins / 5;
constexpr int kParts = 5;                  // of a window, each of which must flow like the whole:
constexpr double kSteadyTolerance = 0.08;  // of the mean; catches the surge when a lid opens, lets scatter pass
constexpr int kErrorBins = 8;              // independent stretches for the standard error

double interpolate(const std::vector<FlowSample>& samples, double t) {
  const auto after = std::lower_bound(samples.begin(), samples.end(), t,
                                      [](const FlowSample& s, double time) { return s.time < time; });
  if (after == samples.begin()) return samples.front().total();
  if (after == samples.end()) return samples.back().total();
  const auto before = after - 1;
  const double f = (t - before->time) / (after->time - before->time);
  return before->total() + f * (after->total() - before->total());
}

double rate_between(const std::vector<FlowSample>& samples, double a, double b) {
  return (interpolate(samples, b) - interpolate(samples, a)) / (b - a);
}

bool is_steady(const std::vector<FlowSample>& samples, double a, double b) {
  const double mean = rate_between(samples, a, b), part = (b - a) / kParts;
  if (mean <= 0) return false;
  for (int k = 0; k < kParts; ++k)
    if (std::abs(rate_between(samples, a + k * part, a + (k + 1) * part) - mean) > kSteadyTolerance * mean)
      return false;
  return true;
}

// Where the surge inside [a, b] has died away: the start, in its first half, that makes the mean of what is left most
// certain, sum (q - mean)^2 / n^2 over its n bins. At least `shortest` seconds stay.
double end_of_transient(const std::vector<FlowSample>& samples, double a, double b, double shortest) {
  const double bin = (b - a) / kBins;
  double q[kBins];
  for (int k = 0; k < kBins; ++k) q[k] = rate_between(samples, a + k * bin, a + (k + 1) * bin);
  double start = a, least = std::numeric_limits<double>::infinity();
  for (int first = 0; first <= kBins / 2 && (kBins - first) * bin >= shortest; ++first) {
    const int n = kBins - first;
    const double mean = std::accumulate(q + first, q + kBins, 0.0) / n;
    double sum2 = 0;
    for (int k = first; k < kBins; ++k) sum2 += (q[k] - mean) * (q[k] - mean);
    if (sum2 / (n * n) < least) least = sum2 / (n * n), start = a + first * bin;
  }
  return start;
}

}  // namespace

bool beyond(const Outlet& outlet, const ParticleState& p, double distance) {
  return dot(p.position - outlet.point, outlet.direction) > distance;
}

double FlowSample::total() const {
  double sum = 0;
  for (double d : discharged) sum += d;
  return sum;
}

std::optional<SteadyFlow> steady_flow_in(const std::vector<FlowSample>& samples, double from, double to) {
  if (samples.size() < 2) return std::nullopt;
  from = std::max(from, samples.front().time), to = std::min(to, samples.back().time);
  if (!(to > from)) return std::nullopt;
  SteadyFlow s{rate_between(samples, from, to), 0, from, to, kErrorBins};
  double sum2 = 0;
  for (int k = 0; k < kErrorBins; ++k) {
    const double width = (to - from) / kErrorBins;
    const double d = rate_between(samples, from + k * width, from + (k + 1) * width) - s.rate;
    sum2 += d * d;
  }
  s.standard_error = std::sqrt(sum2 / (kErrorBins - 1) / kErrorBins);
  return s;
}

std::optional<SteadyFlow> find_steady_flow(const std::vector<FlowSample>& samples, double from, double to,
                                           double shortest) {
  if (samples.size() < kBins || !(to > from)) return std::nullopt;
  const double bin = (to - from) / kBins;
  for (int length = kBins; length >= kFewestBins && length * bin >= shortest; --length) {
    // Of equally long windows the one with the highest rate: a trickle before or after the flow is steady too.
    std::optional<SteadyFlow> best;
    for (int first = 0; first + length <= kBins; ++first) {
      const double a = from + first * bin, b = a + length * bin;
      if (!is_steady(samples, a, b)) continue;
      const auto s = steady_flow_in(samples, a, b);
      if (s && (!best || s->rate > best->rate)) best = s;
    }
    if (best) return steady_flow_in(samples, end_of_transient(samples, best->from, best->to, shortest), best->to);
  }
  return std::nullopt;
}

}  // namespace scree
