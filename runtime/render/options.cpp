#include "runtime/render/options.h"

namespace scree {

CLI::App& add_render_command(CLI::App& app, RenderArguments& a) {
  CLI::App& command = *app.add_subcommand("render", "pictures or a film from the results folder of a run");
  command.add_option("DIR", a.folder, "the results folder")->required();
  command.add_option("--camera", a.cameras,
                     "front (along +y), side (along +x), top, junction (a close-up), free; may be repeated");
  command.add_option(
      "--colour,--color", a.colour,
      "what the particles are coloured by: speed, kind, mass, velocity_z, angular_velocity, ... (default "
      "speed)");
  command.add_option("--range", a.range, "the ends of the colour bar, SI (default: from the values)")->expected(2);
  command.add_option(
      "--cut", a.cuts,
      "cut away a half-space: \"y<0.002\" (m), \"y<\" (at the middle), or \"NX,NY,NZ,D\"; may be repeated");
  command.add_option("--walls", a.walls, "transparent, faint or hidden (default transparent)");
  command.add_option("--size", a.size, "WIDTHxHEIGHT in pixels (default 1920x1080)");
  command.add_option("--out", a.out, "a folder, or a .png file for one picture (default: DIR/pictures)");
  command.add_option("--time", a.times, "s; the moments nearest to these (default: the last)");
  command.add_option("--point", a.point, "X Y Z, m: what the junction camera looks at")->expected(3);
  command.add_option("--position", a.position, "X Y Z, m: where the free camera is")->expected(3);
  command.add_option("--target", a.target, "X Y Z, m: what the free camera looks at")->expected(3);
  command.add_option("--up", a.up, "X Y Z: what is up for the free camera (default 0 0 1)")->expected(3);
  command.add_option("--field-of-view", a.field_of_view_deg, "of the free camera, from below to above, degrees")
      ->check(CLI::Range(1.0, 150.0));
  command.add_option("--width", a.width, "m: an orthographic free camera that sees so much")
      ->check(CLI::PositiveNumber);
  command.add_option("--samples", a.samples, "rays a pixel (default 8)")->check(CLI::Range(1, 64));
  command.add_flag("--plain", a.plain, "without colour bar, scale bar and time");
  command.add_flag("--film", a.film, "every moment there is, as numbered pictures, and as MP4 if ffmpeg is there");
  command.add_option("--frames-per-second", a.frames_per_second, "of the film (default 25)")->check(CLI::Range(1, 120));
  return command;
}

}  // namespace scree
