#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "geometry/bounds.h"
#include "geometry/closest_point.h"
#include "runtime/average_files.h"
#include "runtime/panel_picture.h"

namespace scree {

namespace {

constexpr int kLongestSide = 840, kWidest = 760;  // pixels of a slice
constexpr Srgb kFibre{214, 214, 218}, kOutline{20, 20, 24};
constexpr double kOutlinePixels = 1.6;
constexpr double kSeen = 1e-3;  // solid fraction: where there is less, a mean velocity says little and is left grey

// A plane of cells through the middle of the box, across `axis` (0: x, 1: y), z upwards.
struct Slice {
  const CoarseGrid& grid;
  int axis;
  int layer;

  Slice(const CoarseGrid& g, int across) : grid(g), axis(across), layer(g.cells[across] / 2) {}
  int side() const { return 1 - axis; }
  size_t cell(int u, int k) const {
    const int i = axis == 0 ? layer : u, j = axis == 0 ? u : layer;
    return (size_t(k) * grid.cells[1] + j) * grid.cells[0] + i;
  }
  static double part(const Vec3& v, int axis) { return axis == 0 ? v.x : v.y; }
  double edge() const { return part(grid.spacing, side()); }
  double low() const { return part(grid.origin, side()); }
  double position() const { return part(grid.origin, axis) + (layer + 0.5) * part(grid.spacing, axis); }
  double width() const { return edge() * grid.cells[side()]; }
  double height() const { return grid.spacing.z * grid.cells[2]; }
  Vec3 point(double u, double z) const { return axis == 0 ? Vec3{position(), u, z} : Vec3{u, position(), z}; }
};

// Distance to the nearest fibre at each pixel of a slice, in pixels, where it is small.
struct CutFibres {
  int width, height;
  double pixel;  // m
  std::vector<float> distances;

  CutFibres(const Case& c, const Slice& s, double pixel_size)
      : width(static_cast<int>(std::lround(s.width() / pixel_size))),
        height(static_cast<int>(std::lround(s.height() / pixel_size))),
        pixel(pixel_size),
        distances(size_t(width) * height, 100.0f) {
    for (const Primitive& p : c.solid.primitives)
      if (p.radius > 0) add(prepared(p), inflated(bounds_of(p), 4 * pixel), s);
  }
  void add(const PreparedPrimitive& fibre, const Bounds& b, const Slice& s) {
    if (Slice::part(b.min, s.axis) > s.position() || Slice::part(b.max, s.axis) < s.position()) return;
    const auto clamp = [](double x, int n) { return static_cast<int>(std::clamp(x, 0.0, double(n))); };
    const double top = s.grid.origin.z + s.height();
    const int u0 = clamp((Slice::part(b.min, s.side()) - s.low()) / pixel, width),
              u1 = clamp((Slice::part(b.max, s.side()) - s.low()) / pixel + 1, width);
    const int v0 = clamp((top - b.max.z) / pixel, height), v1 = clamp((top - b.min.z) / pixel + 1, height);
    for (int v = v0; v < v1; ++v)
      for (int u = u0; u < u1; ++u) {
        const double d = distance(fibre, s.point(s.low() + (u + 0.5) * pixel, top - (v + 0.5) * pixel)) / pixel;
        float& least = distances[size_t(v) * width + u];
        least = std::min(least, static_cast<float>(d));
      }
  }
  Srgb over(int u, int v, const Srgb& below) const {
    const double d = distances[size_t(v) * width + u];
    const auto laid = [](const Srgb& a, const Srgb& b, double share) {
      Srgb c;
      for (size_t k = 0; k < 3; ++k) c[k] = static_cast<uint8_t>(std::lround(a[k] + share * (b[k] - a[k])));
      return c;
    };
    const Srgb filled = laid(below, kFibre, std::clamp(0.5 - d, 0.0, 1.0));
    return laid(filled, kOutline, std::clamp(0.5 + kOutlinePixels / 2 - std::abs(d), 0.0, 1.0));
  }
};

struct Quantity {
  const char *file, *name, *unit;
  double factor;  // shown = factor * SI
  std::function<double(const AverageFields&, size_t)> value;
};

const Quantity kQuantities[] = {
    {"solid_fraction", "solid fraction", "", 1, [](const AverageFields& f, size_t k) { return f.solid_fraction[k]; }},
    {"speed", "speed of the mean flow", "mm/s", 1e3,
     [](const AverageFields& f, size_t k) { return norm(f.velocity[k]); }},
    {"granular_temperature", "granular temperature", "mm²/s²", 1e6,
     [](const AverageFields& f, size_t k) { return f.temperature[k]; }},
    {"pressure", "pressure of the grains", "Pa", 1,
     [](const AverageFields& f, size_t k) { return (f.stress[k][0] + f.stress[k][1] + f.stress[k][2]) / 3; }},
    {"mass_flux", "mass flux downwards", "kg/m²/s", 1,
     [](const AverageFields& f, size_t k) { return -f.mass_flux[k].z; }},
};

Panel panel_of(const Slice& s, const CutFibres& cut, const ColourScale& scale, std::function<double(size_t)> value) {
  Panel p;
  p.title = fmt::format("{} = {:.3g} mm", "xy"[s.axis], 1e3 * s.position());
  p.across = fmt::format("{}, mm", "xy"[s.side()]), p.up = "z, mm";
  p.left = 1e3 * s.low(), p.right = 1e3 * (s.low() + s.width());
  p.bottom = 1e3 * s.grid.origin.z, p.top = 1e3 * (s.grid.origin.z + s.height());
  p.width = cut.width, p.height = cut.height;
  p.map = [s, &cut, scale, value = std::move(value)](int u, int v) {
    const int i = std::min(static_cast<int>((u + 0.5) * cut.pixel / s.edge()), s.grid.cells[s.side()] - 1);
    const int k =
        s.grid.cells[2] - 1 - std::min(static_cast<int>((v + 0.5) * cut.pixel / s.grid.spacing.z), s.grid.cells[2] - 1);
    return cut.over(u, v, colour_of(scale, value(s.cell(i, k))));
  };
  return p;
}

}  // namespace

void write_average_pictures(const std::filesystem::path& folder, const std::string& name, const Case& c,
                            const CoarseGrid& grid, const AverageFields& fields) {
  const Slice slices[] = {{grid, 0}, {grid, 1}};
  const double pixel =
      std::max({slices[0].height() / kLongestSide, slices[0].width() / kWidest, slices[1].width() / kWidest});
  const CutFibres cuts[] = {{c, slices[0], pixel}, {c, slices[1], pixel}};
  for (const Quantity& q : kQuantities) {
    const auto shown = [&](size_t k) {
      const bool seen = fields.solid_fraction[k] > kSeen || &q == &kQuantities[0];
      return seen ? q.factor * q.value(fields, k) : std::nan("");
    };
    std::vector<double> values;
    for (const Slice& s : slices)
      for (int k = 0; k < grid.cells[2]; ++k)
        for (int u = 0; u < grid.cells[s.side()]; ++u) values.push_back(shown(s.cell(u, k)));
    const double largest = nearly_largest(values);
    PanelPicture picture;
    picture.title = fmt::format("{}{}", q.name, *q.unit ? fmt::format(", {}", q.unit) : "");
    picture.note =
        fmt::format("mean over the window by Lucy's kernel, half width {:.2g} mm; outlined: fibres; grey: no grains",
                    1e3 * grid.width);
    picture.scale = {q.name, q.unit, 0, largest > 0 ? largest : 1, ColourMap::sequential, {}};
    for (int a = 0; a < 2; ++a) picture.panels.push_back(panel_of(slices[a], cuts[a], picture.scale, shown));
    write_png(folder / fmt::format("{}_{}.png", name, q.file), draw(picture));
  }
}

}  // namespace scree
