#include "runtime/render/command.h"

#include <nlohmann/json.hpp>

#include <fstream>

#include "runtime/case_reader.h"
#include "runtime/render/film.h"
#include "runtime/render/picture.h"
#include "runtime/run_folder.h"

namespace scree {

namespace {

std::optional<Vec3> vector_of(const std::vector<double>& v) {
  if (v.empty()) return std::nullopt;
  return Vec3{v.at(0), v.at(1), v.at(2)};
}

PictureRequest request_of(const RenderArguments& a, const std::string& camera) {
  PictureRequest request;
  request.camera = {camera,
                    vector_of(a.point),
                    vector_of(a.position),
                    vector_of(a.target),
                    vector_of(a.up).value_or(Vec3{0, 0, 1}),
                    a.field_of_view_deg,
                    a.width};
  request.colour = a.colour, request.cuts = a.cuts;
  request.walls = parse_wall_style(a.walls), request.size = parse_size(a.size);
  if (!a.range.empty()) request.range = ValueRange{a.range.at(0), a.range.at(1)};
  if (request.range && !(request.range->min < request.range->max))
    throw CaseError({"--range"}, fmt::format("{:g} {:g}: the first must be less than the second", request.range->min,
                                             request.range->max));
  if (a.samples > 0) request.samples = a.samples;
  request.annotations = !a.plain;
  return request;
}

Case case_of(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "case.toml";
  if (!std::filesystem::is_regular_file(file))
    throw CaseError({folder.string()}, "is not the results folder of a run: it has no case.toml");
  return read_case(file.string());
}

// The moments nearest to the times asked for; the last of all if none is.
std::vector<FrameSource> chosen(const std::vector<FrameSource>& frames, const std::vector<double>& times) {
  if (times.empty()) return {frames.back()};
  std::vector<FrameSource> result;
  for (const double time : times)
    result.push_back(
        *std::ranges::min_element(frames, {}, [&](const FrameSource& f) { return std::abs(f.time - time); }));
  return result;
}

// When each [[stage]] of kind "open" began, from the run's summary, and the walls it opened.
struct Opening {
  double time;
  std::vector<uint32_t> walls;
};
std::vector<Opening> openings_of(const Case& c, const std::filesystem::path& folder) {
  std::ifstream file(folder / "summary.json");
  const nlohmann::json summary = nlohmann::json::parse(file, nullptr, false);
  std::vector<Opening> openings;
  if (!summary.is_object() || !summary.contains("stages")) return openings;
  size_t k = 0;
  for (const auto& stage : summary["stages"]) {
    if (k >= c.stages.size()) break;
    const auto* open = std::get_if<OpenStage>(&c.stages[k++].action);
    if (!open) continue;
    Opening opening{stage.value("start_s", 0.0), {}};
    for (const std::string& name : open->walls)
      opening.walls.push_back(static_cast<uint32_t>(std::ranges::find(c.solid.walls, name) - c.solid.walls.begin()));
    openings.push_back(opening);
  }
  return openings;
}

Solid solid_at(const Case& c, const std::vector<Opening>& openings, double time) {
  Solid solid = c.solid;
  for (const Opening& opening : openings)
    if (!(time < opening.time))
      std::erase_if(solid.primitives, [&](const Primitive& p) {
        return std::ranges::find(opening.walls, p.wall) != opening.walls.end();
      });
  return solid;
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw RunError(fmt::format("cannot make the folder {}: {}", folder.string(), error.message()));
}

// Of an earlier, longer film: they would be the new one's end.
void remove_pictures(const std::filesystem::path& folder) {
  std::error_code ignored;
  for (const std::filesystem::path& path : entries_of(folder))
    if (path.extension() == ".png") std::filesystem::remove(path, ignored);
}

std::string picture_name(const PictureRequest& request, double time) {
  const std::string name = fmt::format("{}_{}", request.camera.name, request.colour);
  return std::isnan(time) ? name + ".png" : fmt::format("{}_{:.6f}.png", name, time);
}

// One range for all of a film: the largest that its first, middle and last moments give.
ValueRange range_of_film(const Case& c, const std::vector<FrameSource>& frames, const std::string& colour) {
  ValueRange range{INFINITY, -INFINITY};
  for (const size_t k : {size_t{0}, frames.size() / 2, frames.size() - 1}) {
    const ColourScale scale = colour_scale(c, colour, values_of(read_particle_frame(frames[k]), colour));
    range = {std::min(range.min, scale.min), std::max(range.max, scale.max)};
  }
  return range;
}

}  // namespace

void render_folder(const RenderArguments& a, const std::function<void(const std::string&)>& tell) {
  const Case c = case_of(a.folder);
  const std::vector<std::string> cameras = a.cameras.empty() ? std::vector<std::string>{"front"} : a.cameras;
  std::vector<PictureRequest> requests;
  for (const std::string& camera : cameras) requests.push_back(request_of(a, camera));
  const std::vector<FrameSource> all = list_particle_frames(a.folder);
  const std::vector<FrameSource> frames = a.film ? all : chosen(all, a.times);
  const std::vector<Opening> openings = openings_of(c, a.folder);
  const bool one_file = a.out.ends_with(".png");
  if (one_file && (a.film || frames.size() * requests.size() > 1))
    throw CaseError({"--out"}, fmt::format("{} is one file, but {} pictures are asked for: name a folder", a.out,
                                           frames.size() * requests.size()));
  const std::filesystem::path out = a.out.empty() ? a.folder / "pictures" : std::filesystem::path(a.out);
  make_folder(one_file ? std::filesystem::absolute(out).parent_path() : out);
  for (PictureRequest& request : requests) {
    const std::filesystem::path film = out / fmt::format("film_{}_{}", request.camera.name, request.colour);
    if (a.film) make_folder(film), remove_pictures(film);
    if (a.film && !request.range) request.range = range_of_film(c, frames, request.colour);
    for (size_t k = 0; k < frames.size(); ++k) {
      const Image image =
          draw_picture(c, read_particle_frame(frames[k]), request, solid_at(c, openings, frames[k].time));
      const std::filesystem::path path = one_file ? out
                                         : a.film ? film / film_frame_name(k)
                                                  : out / picture_name(request, frames[k].time);
      write_png(path, image);
      if (!a.film) tell(path.string());
    }
    if (a.film) tell(make_film(film, a.frames_per_second));
    if (a.film && frames.size() == 1) tell(fmt::format("it is of one moment: {} holds no other", a.folder.string()));
  }
}

}  // namespace scree
