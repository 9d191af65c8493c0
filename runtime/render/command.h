// The command `scree render`: pictures and films from the folder of a run.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace scree {

// As the command line has them; empty: not given.
struct RenderArguments {
  std::filesystem::path folder;      // of the run
  std::vector<std::string> cameras;  // none: front
  std::string colour = "speed";
  std::vector<std::string> cuts;
  std::string walls = "transparent", size = "1920x1080";
  std::string out;  // a .png file for one picture, or a folder; empty: folder/pictures
  std::vector<double> range, position, target, up, point;
  double field_of_view_deg = 30, width = 0;
  std::vector<double> times;  // s: the moments nearest to them; none: the last
  int samples = 0, frames_per_second = 25;
  bool film = false, plain = false;
};

// Draws what is asked for and tells of each file. Throws CaseError for bad input, RunError where a file cannot be
// written.
void render_folder(const RenderArguments& arguments, const std::function<void(const std::string&)>& tell);

}  // namespace scree
