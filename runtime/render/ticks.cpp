#include "runtime/render/ticks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace scree {

double round_down(double x) {
  const double power = std::pow(10, std::floor(std::log10(x)));
  for (const double factor : {10.0, 5.0, 2.0})
    if (factor * power <= x * (1 + 1e-9)) return factor * power;
  return power;
}

Ticks ticks_between(double min, double max, int most) {
  if (min > max) std::swap(min, max);
  if (!(max > min)) return {};
  double step = round_down((max - min) / most);
  const auto count = [&] { return std::floor(max / step + 1e-9) - std::ceil(min / step - 1e-9) + 1; };
  while (count() > most) step = round_down(step * 2.5);  // 1 to 2 to 5 to 10
  const int decimals = std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9)));
  Ticks ticks;
  for (double k = std::ceil(min / step - 1e-9); k * step <= max + 1e-9 * step; ++k) {
    ticks.values.push_back(k * step);
    ticks.labels.push_back(fmt::format("{:.{}f}", k == 0 ? 0 : k * step, decimals));
  }
  return ticks;
}

UnitPrefix prefix_for(double largest, const std::string& unit) {
  if (unit.empty() || !(largest > 0) || !std::isfinite(largest)) return {};
  constexpr const char* kNames[] = {"f", "p", "n", "µ", "m", "", "k", "M", "G", "T"};
  // 0.1 to 100 of the unit itself is not touched: 0.25 m/s, not 250 mm/s.
  if (largest >= 0.0999 && largest < 1e4) return {};
  const int power = std::clamp(static_cast<int>(std::floor(std::log10(largest) / 3 + 1e-9)), -5, 4);
  return {std::pow(1000.0, power), kNames[power + 5]};
}

}  // namespace scree
