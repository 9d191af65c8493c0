#include "runtime/touch_files.h"

#include "runtime/result_folder.h"
#include "runtime/touch_numbers.h"

namespace scree {

namespace {

constexpr uint8_t kQuadrilateral = 9;  // VTK's number for it

// The exposed cells, as corners, and which they are.
struct ExposedMesh {
  VtkGrid grid;
  std::vector<size_t> cells;
  std::vector<uint32_t> patches;  // of each
};

ExposedMesh mesh_of(const TouchSurface& surface) {
  ExposedMesh mesh;
  for (uint32_t k = 0; k < surface.patches().size(); ++k) {
    const TouchPatch& p = surface.patches()[k];
    for (uint32_t row = 0; row < p.rows; ++row)
      for (uint32_t column = 0; column < p.columns; ++column) {
        const size_t cell = p.first + size_t(row) * p.columns + column;
        if (surface.states()[cell] == TouchState::hidden) continue;
        int64_t corners[4];
        for (uint32_t n = 0; n < 4; ++n) {  // round the cell
          const uint32_t up = row + n / 2, along = column + (n == 1 || n == 2);
          const double s = p.length * up / p.rows, share = double(along) / p.columns;
          const Vec3 x = p.at(s, share);
          corners[n] = mesh.grid.add_point(x.x, x.y, x.z);
        }
        mesh.grid.add_cell(kQuadrilateral, corners);
        mesh.cells.push_back(cell), mesh.patches.push_back(k);
      }
  }
  return mesh;
}

}  // namespace

void write_touch_vtkhdf(const std::filesystem::path& path, const Case& c, const TouchSurface& surface,
                        const TouchRecord& record) {
  const ExposedMesh mesh = mesh_of(surface);
  const double looks = static_cast<double>(std::max<uint64_t>(record.looks, 1));
  write_vtkhdf(path, VtkHdfType::unstructured_grid, [&](VtkHdfFile& file) {
    write_grid(file, mesh.grid);
    const auto field = [&](const char* name, const auto& get) {
      std::vector<float> values;
      for (size_t k = 0; k < mesh.cells.size(); ++k)
        values.push_back(static_cast<float>(get(record.cells[mesh.cells[k]], surface.patches()[mesh.patches[k]])));
      file.array(std::string("CellData/") + name, std::span<const float>(values));
    };
    field("touched_share", [&](const TouchSums& s, const TouchPatch&) { return double(s.touched) / looks; });
    field("contacts", [&](const TouchSums& s, const TouchPatch&) { return double(s.contacts) / looks; });
    field("mean_normal_force",
          [&](const TouchSums& s, const TouchPatch&) { return s.contacts ? s.force / double(s.contacts) : 0; });
    field("pressure", [&](const TouchSums& s, const TouchPatch& p) { return s.force / (looks * p.cell_area()); });
    field("sliding_work", [&](const TouchSums& s, const TouchPatch& p) { return s.rubbing / (looks * p.cell_area()); });
    field("dead", [&](const TouchSums& s, const TouchPatch&) { return s.touched == 0; });
    field("primitive", [&](const TouchSums&, const TouchPatch& p) { return p.primitive; });
    field("wall", [&](const TouchSums&, const TouchPatch& p) { return c.solid.primitives[p.primitive].wall; });
    std::vector<uint8_t> reachable;
    for (const size_t cell : mesh.cells) reachable.push_back(surface.states()[cell] == TouchState::open);
    file.array("CellData/reachable", std::span<const uint8_t>(reachable));
  });
}

void write_touch(const std::filesystem::path& out, const Case& c, const TouchSurface& surface,
                 const TouchRecord& record) {
  write_touch_csv(out / "touch.csv", surface, record);
  make_folder(out / "touch");
  write_touch_vtkhdf(out / "touch" / "surface.vtkhdf", c, surface, record);
  write_touch_pictures(out / "touch", c, surface, record);
}

}  // namespace scree
