// From a number to a colour.
#pragma once

#include <string>
#include <vector>

#include "runtime/render/image.h"

namespace scree {

// Perceptually uniform: equal steps of the value look equally far apart, also in grey and to colour-blind eyes.
enum class ColourMap { sequential, diverging };

// x from 0 to 1; beyond the ends the end's colour. NaN: kNoValue.
Srgb colour_of(ColourMap map, double x);
// Distinguishable categories; they repeat after eight.
Srgb colour_of_category(size_t index);
inline constexpr Srgb kNoValue{150, 150, 150};

// What the colours of a picture mean: a range of a quantity, or named categories.
struct ColourScale {
  std::string quantity, unit;  // "speed", "m/s"; unit "": a count or a ratio
  double min = 0, max = 1;
  ColourMap map = ColourMap::sequential;
  std::vector<std::string> categories;  // not empty: the value is an index here, min and max mean nothing
};
Srgb colour_of(const ColourScale& scale, double value);

}  // namespace scree
