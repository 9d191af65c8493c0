// Maps side by side in one picture, each with its axes, under one title and beside one colour bar.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "runtime/render/colour_map.h"

namespace scree {

struct Panel {
  std::string title;                      // above it
  std::string across, up;                 // what its axes are, with the unit: "y, mm"
  double left = 0, right = 1;             // of the axis across, in that unit
  double bottom = 0, top = 1;             // likewise
  int width = 0, height = 0;              // pixels of the map
  std::function<Srgb(int x, int y)> map;  // y from the top
};

struct PanelPicture {
  std::string title, note;  // the note in small letters below the title
  ColourScale scale;        // numbers in `unit` as they are, no prefix
  std::vector<Panel> panels;
};

Image draw(const PanelPicture& picture);

// The value that all but a share of 0.5 % of the numbers do not exceed; 0 if there are none. NaN are left out.
double nearly_largest(std::vector<double> values);

}  // namespace scree
