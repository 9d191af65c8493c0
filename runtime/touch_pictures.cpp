#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "runtime/panel_picture.h"
#include "runtime/touch_files.h"
#include "runtime/touch_numbers.h"

namespace scree {

namespace {

constexpr Srgb kDead{255, 255, 255}, kNoSurface{150, 150, 150};
constexpr const char* kNote = "white: never touched in the window; grey: no surface (inside a fibre or beyond a wall)";

// A quantity of a cell or of several alike, in the unit of the picture.
struct Quantity {
  const char *file, *name, *unit;
  std::function<double(const TouchMeans&)> value;
};
const Quantity kQuantities[] = {
    {"touched_share", "share of the time that it is touched", "%",
     [](const TouchMeans& m) { return 100 * m.touched_share(); }},
    {"contacts", "grains that touch it at a time", "1/mm²",
     [](const TouchMeans& m) { return 1e-6 * m.contact_density(); }},
    {"mean_normal_force", "normal force of a grain on it, mean over contacts", "µN",
     [](const TouchMeans& m) { return 1e6 * m.mean_force(); }},
    {"pressure", "pressure of the grains on the surface", "Pa", [](const TouchMeans& m) { return m.pressure(); }},
    {"sliding_work", "work of grains that slide on the surface", "W/m²",
     [](const TouchMeans& m) { return m.rubbing_per_area(); }},
};

// A map of means, columns x rows, row 0 below.
struct MeansMap {
  uint32_t rows = 0, columns = 0;
  std::vector<TouchMeans> cells;
  const TouchMeans& at(uint32_t row, uint32_t column) const { return cells[size_t(row) * columns + column]; }
};

// Column `first_column` comes first.
MeansMap map_of(const TouchPatch& p, const TouchSurface& surface, const TouchRecord& record, uint32_t first_column) {
  MeansMap map{p.rows, p.columns, std::vector<TouchMeans>(p.cells())};
  for (uint32_t row = 0; row < p.rows; ++row)
    for (uint32_t column = 0; column < p.columns; ++column) {
      const size_t cell = p.first + size_t(row) * p.columns + (column + first_column) % p.columns;
      TouchMeans& m = map.cells[size_t(row) * p.columns + column];
      m.looks = record.looks;
      m.add(p.cell_area(), surface.states()[cell], record.cells[cell]);
    }
  return map;
}

// A fibre's columns from -180 to 180 degrees, the top in the middle.
MeansMap map_of_fibre(const TouchPatch& p, const TouchSurface& surface, const TouchRecord& record) {
  return map_of(p, surface, record, p.columns / 2);
}

Srgb colour_of(const ColourScale& scale, const Quantity& q, const TouchMeans& m) {
  if (m.area == 0) return kNoSurface;
  return m.contacts == 0 ? kDead : scree::colour_of(scale, q.value(m));
}

ColourScale scale_of(const Quantity& q, const std::vector<MeansMap>& maps) {
  std::vector<double> values;
  for (const MeansMap& map : maps)
    for (const TouchMeans& m : map.cells)
      if (m.area > 0) values.push_back(q.value(m));
  const double largest = nearly_largest(std::move(values));
  return {q.name, q.unit, 0, largest > 0 ? largest : 1, ColourMap::sequential, {}};
}

Panel panel_of(const MeansMap& map, const Quantity& q, const ColourScale& scale, int width, int height) {
  Panel p;
  p.width = width, p.height = height;
  p.map = [&map, &q, scale, width, height](int u, int v) {
    const uint32_t column = static_cast<uint32_t>(uint64_t(u) * map.columns / width);
    const uint32_t row = map.rows - 1 - static_cast<uint32_t>(uint64_t(v) * map.rows / height);
    return colour_of(scale, q, map.at(row, column));
  };
  return p;
}

std::string title_of(const Quantity& q, const std::string& of) { return fmt::format("{}: {}, {}", of, q.name, q.unit); }

// ---- fibres alike

struct FibreClass {
  double inclination = 0, length = 0;  // degrees from the horizontal; m
  size_t fibres = 0;
  MeansMap map;
};

// Fibres with the same inclination and length, averaged.
std::vector<FibreClass> classes_of(const Case& c, const TouchSurface& surface, const TouchRecord& record) {
  const Vec3 up = norm(c.gravity) > 0 ? unit(-c.gravity) : Vec3{0, 0, 1};
  std::map<std::array<long, 3>, FibreClass> classes;
  for (const TouchPatch& p : surface.patches()) {
    if (!p.fibre) continue;
    const double inclination = std::asin(std::clamp(dot(p.along, up), -1.0, 1.0)) * 180 / M_PI;
    FibreClass& k = classes[{std::lround(inclination * 2), std::lround(p.length * 1e6), long{p.rows}}];
    MeansMap map = map_of_fibre(p, surface, record);
    if (k.fibres++ == 0)
      k.inclination = inclination, k.length = p.length, k.map = std::move(map);
    else
      for (size_t cell = 0; cell < map.cells.size(); ++cell) k.map.cells[cell].add(map.cells[cell]);
  }
  std::vector<FibreClass> result;
  for (auto& [key, one] : classes) result.push_back(std::move(one));
  std::ranges::stable_sort(result, std::greater{}, &FibreClass::fibres);
  return result;
}

void draw_classes(const std::filesystem::path& folder, const std::vector<FibreClass>& classes) {
  constexpr size_t kMost = 4;
  constexpr int kWidth = 300, kHeight = 420;
  std::vector<MeansMap> maps;
  for (size_t k = 0; k < std::min(kMost, classes.size()); ++k) maps.push_back(classes[k].map);
  for (const Quantity& q : kQuantities) {
    PanelPicture picture{title_of(q, "mean over fibres alike"), kNote, scale_of(q, maps), {}};
    for (size_t k = 0; k < maps.size(); ++k) {
      Panel p = panel_of(maps[k], q, picture.scale, kWidth, kHeight);
      p.title = fmt::format("{} fibres, {:.3g}° from horizontal", classes[k].fibres, classes[k].inclination);
      p.across = "angle round it, °, 0: top", p.up = "along, mm";
      p.left = -180, p.right = 180, p.bottom = 0, p.top = 1e3 * classes[k].length;
      picture.panels.push_back(std::move(p));
    }
    write_png(folder / fmt::format("fibres_{}.png", q.file), draw(picture));
  }
}

// ---- every fibre by itself, in rows

void draw_all_fibres(const std::filesystem::path& folder, const TouchSurface& surface, const TouchRecord& record) {
  constexpr size_t kMost = 4000;
  constexpr int kGapPixels = 5, kPixelsAcross = 1250;
  std::vector<MeansMap> maps;
  for (const TouchPatch& p : surface.patches())
    if (p.fibre && maps.size() < kMost) maps.push_back(map_of_fibre(p, surface, record));
  uint32_t rows = 1, columns = 1;
  for (const MeansMap& m : maps) rows = std::max(rows, m.rows), columns = std::max(columns, m.columns);
  rows = std::min(rows, 200u);
  const int pixel = maps.size() <= 150 ? 5 : 3;
  const int wide = pixel * static_cast<int>(columns) + kGapPixels, tall = pixel * static_cast<int>(rows) + kGapPixels;
  const size_t per_row = std::min<size_t>(std::max(1, kPixelsAcross / wide), maps.size());
  const size_t lines = (maps.size() + per_row - 1) / per_row;
  const Quantity& q = kQuantities[0];
  PanelPicture picture{title_of(q, "every fibre, unrolled"),
                       fmt::format("across: angle from -180° to 180°, top in the middle; upwards: along; {}", kNote),
                       scale_of(q, maps),
                       {}};
  Panel p;
  p.width = static_cast<int>(per_row) * wide, p.height = static_cast<int>(lines) * tall;
  p.across = "fibres in a row, in the order of the case", p.up = "rows";
  p.left = 0, p.right = static_cast<double>(per_row), p.bottom = static_cast<double>(lines), p.top = 0;
  p.map = [&, scale = picture.scale](int u, int v) {
    const size_t fibre = size_t(v / tall) * per_row + size_t(u / wide);
    const int column = u % wide / pixel, row = v % tall / pixel;
    if (fibre >= maps.size() || column >= static_cast<int>(columns) || row >= static_cast<int>(rows))
      return Srgb{90, 90, 96};
    const MeansMap& m = maps[fibre];
    return colour_of(scale, q,
                     m.at(m.rows - 1 - static_cast<uint32_t>(row) * m.rows / rows,
                          static_cast<uint32_t>(column) * m.columns / columns));
  };
  picture.panels.push_back(std::move(p));
  write_png(folder / "every_fibre.png", draw(picture));
}

// ---- walls

void draw_wall(const std::filesystem::path& folder, const std::string& name,
               const std::vector<const TouchPatch*>& faces, const TouchSurface& surface, const TouchRecord& record) {
  constexpr size_t kMost = 6;
  constexpr double kWidth = 300, kHeight = 640;  // pixels of a face
  std::vector<MeansMap> maps;
  double widest = 0, tallest = 0;
  for (const TouchPatch* p : faces) {
    if (maps.size() == kMost) break;
    maps.push_back(map_of(*p, surface, record, 0));
    widest = std::max(widest, p->width), tallest = std::max(tallest, p->length);
  }
  const double pixel = std::max(widest / kWidth, tallest / kHeight);  // m
  for (const Quantity& q : kQuantities) {
    PanelPicture picture{title_of(q, "wall '" + name + "'"), kNote, scale_of(q, maps), {}};
    for (size_t k = 0; k < maps.size(); ++k) {
      const TouchPatch& f = *faces[k];
      const auto pixels = [&](double length) { return std::max(4, static_cast<int>(std::lround(length / pixel))); };
      Panel p = panel_of(maps[k], q, picture.scale, pixels(f.width), pixels(f.length));
      p.title = fmt::format("face {}", k + 1);
      p.across = "across, mm", p.up = "along, mm";
      p.left = 0, p.right = 1e3 * f.width, p.bottom = 0, p.top = 1e3 * f.length;
      picture.panels.push_back(std::move(p));
    }
    write_png(folder / fmt::format("wall_{}_{}.png", name, q.file), draw(picture));
  }
}

}  // namespace

void write_touch_pictures(const std::filesystem::path& folder, const Case& c, const TouchSurface& surface,
                          const TouchRecord& record) {
  if (const std::vector<FibreClass> classes = classes_of(c, surface, record); !classes.empty()) {
    draw_classes(folder, classes);
    draw_all_fibres(folder, surface, record);
  }
  for (const uint32_t w : c.output.touch.walls) {
    std::vector<const TouchPatch*> faces;
    for (const TouchPatch& p : surface.patches())
      if (!p.fibre && c.solid.primitives[p.primitive].wall == w) faces.push_back(&p);
    const bool touched = std::ranges::any_of(faces, [&](const TouchPatch* p) {
      return means_of(*p, surface, record, [](uint32_t, uint32_t) { return true; }).contacts > 0;
    });
    if (touched) draw_wall(folder, c.solid.walls[w], faces, surface, record);
  }
}

}  // namespace scree
