#include "runtime/residence_pictures.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "geometry/bounds.h"
#include "runtime/panel_picture.h"
#include "runtime/result_folder.h"

namespace scree {

namespace {

constexpr Srgb kPaper{255, 255, 255}, kFibre{222, 222, 226}, kOutline{25, 25, 30};
constexpr double kMilligram = 1e-6, kMillimetre = 1e-3;

// ---- the histogram

constexpr int kHistogramWidth = 760, kHistogramHeight = 420;
constexpr double kHeadroom = 1.05;  // of the tallest bar

// Bars, coloured by the share of the mass that has come through by the end of their bin.
void draw_times(const std::filesystem::path& path, const std::vector<ResidenceBin>& bins, double entered) {
  double all = 0, tallest = 0;
  for (const ResidenceBin& bin : bins) all += bin.mass, tallest = std::max(tallest, bin.mass);
  PanelPicture picture;
  picture.title = fmt::format("residence times, mass in bins of {:.4g} s", bins[0].to - bins[0].from);
  picture.note = fmt::format(
      "of {:.3g} mg that entered {:.3g} % had come through at the end; colour: share of those that took no longer, %",
      entered / kMilligram, 100 * all / entered);
  picture.scale = {"share", "%", 0, 100, ColourMap::sequential, {}};
  std::vector<double> shares;
  double sum = 0;
  for (const ResidenceBin& bin : bins) shares.push_back(100 * (sum += bin.mass) / all);
  Panel p;
  p.across = "time from entry to exit, s", p.up = "mass, mg";
  p.left = 0, p.right = bins.back().to, p.bottom = 0, p.top = kHeadroom * tallest / kMilligram;
  p.width = kHistogramWidth, p.height = kHistogramHeight;
  p.map = [&bins, shares, scale = picture.scale, top = kHeadroom * tallest](int u, int v) {
    const size_t k = static_cast<size_t>((u + 0.5) / kHistogramWidth * static_cast<double>(bins.size()));
    const bool bar = top * (1 - (v + 0.5) / kHistogramHeight) < bins[k].mass;
    return bar ? colour_of(scale, shares[k]) : kPaper;
  };
  picture.panels.push_back(std::move(p));
  write_png(path, draw(picture));
}

// ---- the maps

constexpr int kMostWide = 420, kMostTall = 640;  // pixels
constexpr double kLeastDisc = 6, kDiscInFibres = 1.5;
constexpr double kMargin = 0.04;  // of the longer side

// What is left at the junctions that one sees in one place.
struct Place {
  double across, up;  // m
  double mass = 0;
};

double across_of(const Vec3& x, int axis) { return axis == 0 ? x.x : x.y; }

std::vector<Place> places_of(const std::vector<Retained>& retained, int axis, double same) {
  std::map<std::pair<int64_t, int64_t>, Place> places;
  for (const Retained& r : retained) {
    const double across = across_of(r.at, axis);
    const auto key = std::pair{std::llround(across / same), std::llround(r.at.z / same)};
    places.try_emplace(key, Place{across, r.at.z}).first->second.mass += r.mass;
  }
  std::vector<Place> result;
  for (const auto& [key, place] : places) result.push_back(place);
  return result;
}

// Looking along y (axis 0: x to the right) or along x (axis 1: y to the right).
struct View {
  int axis;
  Bounds box;    // m
  double pixel;  // m
  int width() const { return pixels(across_of(box.max, axis) - across_of(box.min, axis)); }
  int height() const { return pixels(box.max.z - box.min.z); }
  int pixels(double length) const { return std::max(1, static_cast<int>(std::lround(length / pixel))); }
  double u(double across) const { return (across - across_of(box.min, axis)) / pixel; }
  double v(double up) const { return (box.max.z - up) / pixel; }
};

// Calls paint(u, v) for each pixel whose middle is within `reach` pixels of the line from a to b.
template <class Paint>
void near_line(const Image& image, double ua, double va, double ub, double vb, double reach, const Paint& paint) {
  const auto clamp = [](double x, int n) { return static_cast<int>(std::clamp(x, 0.0, double(n))); };
  const double length = (ub - ua) * (ub - ua) + (vb - va) * (vb - va);
  for (int v = clamp(std::min(va, vb) - reach, image.height()); v < clamp(std::max(va, vb) + reach + 1, image.height());
       ++v)
    for (int u = clamp(std::min(ua, ub) - reach, image.width()); u < clamp(std::max(ua, ub) + reach + 1, image.width());
         ++u) {
      const double x = u + 0.5 - ua, y = v + 0.5 - va;
      const double s = length > 0 ? std::clamp((x * (ub - ua) + y * (vb - va)) / length, 0.0, 1.0) : 0;
      const double d = std::hypot(x - s * (ub - ua), y - s * (vb - va));
      if (d <= reach) paint(u, v, d);
    }
}

Image map_of(const View& view, const Case& c, const std::vector<Place>& places, const ColourScale& scale) {
  Image image(view.width(), view.height());
  image.fill(0, 0, image.width(), image.height(), kPaper);
  for (const Primitive& p : c.solid.primitives)
    if (const auto* axis = std::get_if<Segment>(&p.skeleton))
      near_line(image, view.u(across_of(axis->a, view.axis)), view.v(axis->a.z), view.u(across_of(axis->b, view.axis)),
                view.v(axis->b.z), p.radius / view.pixel, [&](int u, int v, double) { image.set(u, v, kFibre); });
  const double disc = std::max(kLeastDisc, kDiscInFibres * 0.5 * c.fibres.diameter / view.pixel);
  for (const Place& place : places)
    near_line(image, view.u(place.across), view.v(place.up), view.u(place.across), view.v(place.up), disc,
              [&](int u, int v, double d) {
                const Srgb inside = place.mass > 0 ? colour_of(scale, place.mass / kMilligram) : kPaper;
                image.set(u, v, d > disc - 1.5 ? kOutline : inside);
              });
  return image;
}

void draw_retained(const std::filesystem::path& path, const Case& c, const std::vector<Retained>& retained) {
  Bounds box = empty_bounds();
  for (const Retained& r : retained) box = united(box, {r.at, r.at});
  const Vec3 edges = box.max - box.min;
  const double longest = std::max({edges.x, edges.y, edges.z, 2 * c.fibres.diameter});
  box = inflated(box, kMargin * longest + c.fibres.diameter);
  const double pixel = std::max(
      {(box.max.x - box.min.x) / kMostWide, (box.max.y - box.min.y) / kMostWide, (box.max.z - box.min.z) / kMostTall});
  const View views[] = {{0, box, pixel}, {1, box, pixel}};
  std::vector<std::vector<Place>> places;
  double all = 0, along = 0, most = 0;
  for (const View& view : views) places.push_back(places_of(retained, view.axis, 1e-3 * longest));
  for (const auto& seen : places)
    for (const Place& place : seen) most = std::max(most, place.mass / kMilligram);
  for (const Retained& r : retained) all += r.mass, along += r.mass_along_fibres();
  PanelPicture picture;
  picture.title = "mass at each junction at the end of the run, mg";
  picture.note = fmt::format(
      "by the nearest junction, summed along the line of sight; in all {:.3g} mg, {:.3g} mg of "
      "it along the fibres or still falling; white: none",
      all / kMilligram, along / kMilligram);
  picture.scale = {"mass", "mg", 0, most > 0 ? most : 1, ColourMap::sequential, {}};
  for (size_t k = 0; k < 2; ++k) {
    const View& view = views[k];
    Panel p;
    p.title = k == 0 ? "from the front" : "from the side";
    p.across = k == 0 ? "x, mm" : "y, mm", p.up = "z, mm";
    p.left = across_of(box.min, view.axis) / kMillimetre, p.right = across_of(box.max, view.axis) / kMillimetre;
    p.bottom = box.min.z / kMillimetre, p.top = box.max.z / kMillimetre;
    p.width = view.width(), p.height = view.height();
    p.map = [image = map_of(view, c, places[k], picture.scale)](int u, int v) { return image.at(u, v); };
    picture.panels.push_back(std::move(p));
  }
  write_png(path, draw(picture));
}

}  // namespace

void write_residence_pictures(const std::filesystem::path& folder, const Case& c, const std::vector<ResidenceBin>& bins,
                              const std::vector<Retained>& retained, double entered) {
  if (bins.empty() && retained.empty()) return;
  make_folder(folder);
  if (!bins.empty()) draw_times(folder / "times.png", bins, entered);
  if (!retained.empty()) draw_retained(folder / "retained.png", c, retained);
}

}  // namespace scree
