#include "runtime/render/picture.h"

#include <charconv>

#include "runtime/render/annotations.h"
#include "runtime/render/case_scene.h"
#include "runtime/render/known_name.h"

namespace scree {

namespace {

std::vector<double> numbers_in(const std::string& text) {
  std::vector<double> numbers;
  const char *at = text.data(), *end = at + text.size();
  while (at <= end) {
    double x = 0;
    const auto [after, error] = std::from_chars(at, end, x);
    if (error != std::errc() || !std::isfinite(x) || (after != end && *after != ',')) return {};
    numbers.push_back(x);
    at = after + 1;
  }
  return numbers;
}

std::vector<CutPlane> cuts_of(const PictureRequest& request, const Bounds& region) {
  std::vector<CutPlane> cuts;
  for (const std::string& text : request.cuts) cuts.push_back(parse_cut(text, region));
  return cuts;
}

// Takes the frame apart as it goes: ten million grains are in memory once, not three times.
void add_particles(Scene& scene, ParticleFrame frame, const ColourScale& scale, std::vector<double> values) {
  frame.fields.clear(), frame.fields.shrink_to_fit();
  scene.ball_colours.reserve(frame.count());
  for (const double value : values) scene.ball_colours.push_back(colour_of(scale, value));
  std::vector<double>().swap(values);
  scene.balls.reserve(frame.count());
  for (size_t k = 0; k < frame.count(); ++k) scene.balls.push_back({frame.positions[k], frame.radii[k]});
}

// A junction would hide behind the grains before it. Those before its middle go, the others stay whole; the fibres that
// come towards the eye are cut just before the grains that stay.
void lay_bare(Scene& scene, const Vec3& junction) {
  size_t kept = 0;
  double largest = 0;
  for (size_t k = 0; k < scene.balls.size(); ++k) {
    if (scene.balls[k].centre.y < junction.y) continue;
    largest = std::max(largest, scene.balls[k].radius);
    scene.balls[kept] = scene.balls[k], scene.ball_colours[kept++] = scene.ball_colours[k];
  }
  scene.balls.resize(kept), scene.ball_colours.resize(kept);
  scene.cuts.push_back({{0, -1, 0}, largest - junction.y});
}

}  // namespace

PictureSize parse_size(const std::string& text) {
  PictureSize size{0, 0};
  const size_t cross = text.find('x');
  const auto side = [&](std::string_view digits) {
    int pixels = 0;
    const auto [after, error] = std::from_chars(digits.data(), digits.data() + digits.size(), pixels);
    return error == std::errc() && after == digits.data() + digits.size() ? pixels : 0;
  };
  if (cross != std::string::npos)
    size = {side(std::string_view(text).substr(0, cross)), side(std::string_view(text).substr(cross + 1))};
  const auto allowed = [](int pixels) { return pixels >= kLeastSide && pixels <= kMostSide; };
  if (!allowed(size.width) || !allowed(size.height))
    throw std::invalid_argument(fmt::format(
        "'{}' is not a size, must be WIDTHxHEIGHT, each {} to {} pixels, as 1920x1080", text, kLeastSide, kMostSide));
  return size;
}

CutPlane parse_cut(const std::string& text, const Bounds& region) {
  constexpr const char* kForm =
      "must be an axis, < or > and a coordinate in m, as \"y<0.002\" (cuts away where y is less), \"y<\" (at the "
      "middle), "
      "or \"NX,NY,NZ,D\" (cuts away where NX x + NY y + NZ z > D)";
  const auto fail = [&] { throw std::invalid_argument(fmt::format("'{}' is not a cut, {}", text, kForm)); };
  const size_t axis = text.empty() ? 3 : text[0] - size_t{'x'};
  if (axis < 3 && text.size() >= 2 && (text[1] == '<' || text[1] == '>')) {
    const double sign = text[1] == '>' ? 1 : -1;
    const Vec3 normal{axis == 0 ? sign : 0, axis == 1 ? sign : 0, axis == 2 ? sign : 0};
    if (text.size() == 2) return {normal, dot(normal, 0.5 * (region.min + region.max))};
    const std::vector<double> at = numbers_in(text.substr(2));
    if (at.size() != 1) fail();
    return {normal, sign * at[0]};
  }
  const std::vector<double> n = numbers_in(text);
  if (n.size() != 4 || !(norm(Vec3{n[0], n[1], n[2]}) > 0)) fail();
  const double length = norm(Vec3{n[0], n[1], n[2]});
  return {(1 / length) * Vec3{n[0], n[1], n[2]}, n[3] / length};
}

WallStyle parse_wall_style(const std::string& text) {
  const std::vector<std::string> names{"transparent", "faint", "hidden"};
  for (size_t k = 0; k < names.size(); ++k)
    if (text == names[k]) return static_cast<WallStyle>(k);
  fail_unknown_name("style of walls", text, names);
}

Image draw_picture(const Case& c, ParticleFrame frame, const PictureRequest& request, const Solid& solid) {
  std::vector<double> values = values_of(frame, request.colour);
  const ColourScale scale = colour_scale(c, request.colour, values, request.range);
  const Bounds region = region_of_interest(c, frame);
  const PictureSize& size = request.size;
  const CameraSubject subject = camera_subject(c, region);
  const Camera camera = make_camera(request.camera, subject, static_cast<double>(size.width) / size.height);
  const double time = frame.time;
  Scene scene;
  add_particles(scene, std::move(frame), scale, std::move(values));
  add_solid(scene, solid);
  scene.wall_style = request.walls;
  scene.cuts = cuts_of(request, region);
  if (request.camera.name == "junction" && scene.cuts.empty()) lay_bare(scene, camera.target);
  Image image = render(std::move(scene), camera, size, request.samples);
  if (request.annotations) annotate(image, {scale, scale_bar(camera, size.width, size.height), c.title, time});
  return image;
}

}  // namespace scree
