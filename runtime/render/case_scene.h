// What a case's solid looks like, and where to look.
#pragma once

#include "runtime/case.h"
#include "runtime/render/camera.h"
#include "runtime/render/particle_frame.h"
#include "runtime/render/scene.h"

namespace scree {

// Fibres, walls and the walls' edges.
void add_solid(Scene& scene, const Solid& solid);

// Where the particles of a case are on their way: its fibres, walls, the regions they are inserted in and where they
// are taken out, without what is above the fibres and regions (the empty top of a hopper). The same in every picture of
// a run; of a case that has no such extent, where the particles are now.
Bounds region_of_interest(const Case& c, const ParticleFrame& now);

// The region, and the junction of the most fibres nearest the middle of them all.
CameraSubject camera_subject(const Case& c, const Bounds& region);

}  // namespace scree
