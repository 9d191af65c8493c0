#include "geometry/porosity.h"

#include <algorithm>
#include <numbers>

#include "geometry/argument.h"
#include "geometry/bounds.h"
#include "geometry/capsule_columns.h"

namespace scree {

namespace {

double longest_edge(const Bounds& box) {
  const Vec3 size = box.max - box.min;
  return std::max({size.x, size.y, size.z});
}

void check_box(const Bounds& box) {
  const double volume = volume_of(box);
  require(volume > 0 && std::isfinite(volume), "volume of the section", volume, "m3", "in (0, inf) m3");
}

// Where the search starts: the diameter if the fibres were long cylinders in the box that do not overlap.
double diameter_without_overlap(std::span<const Segment> axes, const Bounds& box, double solid_fraction) {
  double length = 0;
  for (const Segment& axis : axes) length += norm(axis.b - axis.a);
  const double guess = std::sqrt(4 * solid_fraction * volume_of(box) / (std::numbers::pi * length));
  return std::min(guess, longest_edge(box));
}

struct Trial {
  double diameter2, excess;  // m2; solid fraction less the one asked for
};

// Regula falsi (Illinois variant) between `low` (excess < 0) and `high` (excess >= 0), in the diameter's square, in
// which a thin network's solid fraction is linear.
template <class Excess>
double solve_between(Trial low, Trial high, const Excess& excess) {
  constexpr double kTolerance = 1e-6;  // of the diameter's square: the middle is within 2.5e-7 of the diameter
  int side = 0;  // which end the last trial replaced; the end that stays for a second time counts for half
  for (int round = 0; round < 100 && high.diameter2 - low.diameter2 > kTolerance * high.diameter2; ++round) {
    const double weight = high.excess / (high.excess - low.excess);
    // Never closer to an end than half the tolerance: so the last step closes the bracket from both sides.
    const double margin = 0.5 * kTolerance * high.diameter2;
    const double middle = std::clamp(high.diameter2 - weight * (high.diameter2 - low.diameter2), low.diameter2 + margin,
                                     high.diameter2 - margin);
    const Trial trial{middle, excess(std::sqrt(middle))};
    if (trial.excess < 0) {
      low = trial;
      if (side == -1) high.excess *= 0.5;
      side = -1;
    } else {
      high = trial;
      if (side == 1) low.excess *= 0.5;
      side = 1;
    }
  }
  return std::sqrt(0.5 * (low.diameter2 + high.diameter2));
}

Bounds eighth_of_cell(const OctetLattice& lattice) {
  const double half = 0.5 * lattice.cell_size;
  return {lattice.origin, lattice.origin + Vec3{half, half, half}};
}

std::vector<Segment> axes_of_one_cell(const OctetLattice& lattice) {
  return fibre_axes(octet_lattice(lattice.cell_size, {1, 1, 1}, lattice.origin));
}

}  // namespace

double porosity(std::span<const Segment> axes, double diameter, const Bounds& box) {
  check_box(box);
  require_not_negative("fibre diameter", diameter);
  return 1 - CapsuleColumns(axes, 0.5 * diameter, box).solid_fraction();
}

double fibre_diameter_for_porosity(std::span<const Segment> axes, const Bounds& box, double target) {
  check_box(box);
  const double largest = longest_edge(box);
  const auto excess = [&](double diameter) { return target - porosity(axes, diameter, box); };
  const auto refuse_unless = [&](bool reachable) {
    if (reachable) return;
    require(false, "porosity", target, "",
            fmt::format("in [{:.6g}, 1), what fibre diameters in (0, {:g}] m make here", porosity(axes, largest, box),
                        largest));
  };
  refuse_unless(target >= 0 && target < 1);

  Trial low{0, target - 1};
  double diameter = axes.empty() ? largest : diameter_without_overlap(axes, box, 1 - target);
  Trial high{diameter * diameter, excess(diameter)};
  while (high.excess < 0) {
    refuse_unless(diameter < largest);
    low = high;
    diameter = std::min(1.25 * diameter, largest);
    high = {diameter * diameter, excess(diameter)};
  }
  return solve_between(low, high, excess);
}

double porosity(const OctetLattice& lattice, double diameter) {
  return porosity(axes_of_one_cell(lattice), diameter, eighth_of_cell(lattice));
}

double fibre_diameter_for_porosity(const OctetLattice& lattice, double target) {
  return fibre_diameter_for_porosity(axes_of_one_cell(lattice), eighth_of_cell(lattice), target);
}

}  // namespace scree
