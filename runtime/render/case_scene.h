// What a case's solid looks like, and where to look.
#pragma once

#include "runtime/case.h"
#include "runtime/render/camera.h"
#include "runtime/render/particle_frame.h"
#include "runtime/render/scene.h"

namespace scree {

// Fibres, walls and the walls' edges, without the walls in `opened` (indices in Solid::walls).
void add_solid(Scene& scene, const Solid& solid, const std::vector<uint32_t>& opened = {});

// Where the particles of a case are on their way: its fibres and the regions they are inserted in; of a case without
// either, where they are now. In every picture of a run the same.
Bounds region_of_interest(const Case& c, const ParticleFrame& now);

// The region, and the junction of fibres nearest the middle of the fibres.
CameraSubject camera_subject(const Case& c, const Bounds& region);

}  // namespace scree
