// A picture of a case at one moment: what a user asks for, and its drawing. This is what the command, the film and a
// run's own pictures share.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runtime/render/quantity.h"
#include "runtime/render/renderer.h"

namespace scree {

inline constexpr int kLeastSide = 64, kMostSide = 16384;  // pixels of a picture

// "1920x1080". Throws std::invalid_argument.
PictureSize parse_size(const std::string& text);

// What is cut away: "y<0.002" (m), "x>0", "y<" (at the middle of the region), or "NX,NY,NZ,D": where
// NX x + NY y + NZ z > D. Throws std::invalid_argument.
CutPlane parse_cut(const std::string& text, const Bounds& region);

// Throws std::invalid_argument for a wall style that is not transparent, faint or hidden.
WallStyle parse_wall_style(const std::string& text);

// `solid`: what is left of the case's by then. Throws std::invalid_argument for a name, cut or size that is not known
// or allowed.
Image draw_picture(const Case& c, ParticleFrame frame, const PictureRequest& request, const Solid& solid);

}  // namespace scree
