// [[output.picture]]: pictures that a run draws of itself while it goes on, as DIR/pictures/NAME_TIME.png.
#pragma once

#include "runtime/case_table.h"
#include "runtime/observer.h"
#include "runtime/render/particle_frame.h"

namespace scree {

inline constexpr double kPictureBytesPerParticle = 150;  // while one is drawn

// Reads every [[output.picture]] of `output`: name, camera, colour, range, cut, walls, size, samples, what a free
// camera or a junction needs, and its moments (runtime/case_moments.h). Names of cameras and quantities are checked
// here.
void read_pictures(TableReader& output, std::vector<RunPicture>& pictures);

// What `colour` may name: quantities of the fields that field files can have (runtime/particle_fields.h), and of mass.
std::vector<std::string> run_quantities();
// The particles as they are, with the field that the quantity is of.
ParticleFrame frame_now(const Case& c, const Engine& engine, const std::string& quantity);

// Draws it at its moments. Throws CaseError for a junction camera in a case without one; a file that cannot be written
// is a RunError of look().
std::unique_ptr<Observer> make_picture_observer(const Case& c, const RunPicture& picture, double dt);

}  // namespace scree
