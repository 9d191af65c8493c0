// Round numbers for axes and bars.
#pragma once

#include <string>
#include <vector>

namespace scree {

// 1, 2 or 5 times a power of ten: the largest that is at most x, x > 0.
double round_down(double x);

struct Ticks {
  std::vector<double> values;       // from min to max, at a round distance
  std::vector<std::string> labels;  // each exact, all with the same number of decimals
};
// At most `most` ticks (two or more) between min and max, ascending whichever of them is larger; none where they are
// equal or not numbers.
Ticks ticks_between(double min, double max, int most);

// The SI prefix with which `largest` reads as 0.1 to 9999: value / factor in prefix + unit.
struct UnitPrefix {
  double factor = 1;
  std::string prefix;
};
UnitPrefix prefix_for(double largest, const std::string& unit);

}  // namespace scree
