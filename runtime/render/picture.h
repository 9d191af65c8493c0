// A picture of a case at one moment: what a user asks for, and its drawing. This is what the command, the film and a
// run's own pictures share.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runtime/render/quantity.h"
#include "runtime/render/renderer.h"

namespace scree {

struct PictureRequest {
  CameraRequest camera;
  std::string colour = "speed";     // a quantity (runtime/render/quantity.h)
  std::optional<ValueRange> range;  // of the colours; not given: from the values
  std::vector<std::string> cuts;    // as parse_cut() reads them
  WallStyle walls = WallStyle::transparent;
  PictureSize size;
  int samples = kDefaultSamples;
  bool annotations = true;
};

inline constexpr int kLeastSide = 64, kMostSide = 16384;  // pixels of a picture

// "1920x1080". Throws CaseError.
PictureSize parse_size(const std::string& text);

// What is cut away: "y<0.002" (m), "x>0", "y<" (at the middle of the region), or "NX,NY,NZ,D": where
// NX x + NY y + NZ z > D. Throws CaseError.
CutPlane parse_cut(const std::string& text, const Bounds& region);

// Throws CaseError for a wall style that is not transparent, faint or hidden.
WallStyle parse_wall_style(const std::string& text);

// Throws CaseError for a name, cut or size that is not known or allowed. `opened`: walls that are gone by now, indices
// in Solid::walls.
Image draw_picture(const Case& c, const ParticleFrame& frame, const PictureRequest& request,
                   const std::vector<uint32_t>& opened = {});

}  // namespace scree
