#include "runtime/average_files.h"

#include <cmath>

#include <fmt/format.h>

#include "runtime/result_folder.h"

namespace scree {

namespace {

// One or several numbers a cell, as the file has them.
template <class Get>
void write_field(VtkHdfFile& file, const CoarseGrid& grid, const std::string& name, uint64_t components,
                 const Get& get) {
  std::vector<float> values(grid.size() * components);
  for (size_t k = 0; k < grid.size(); ++k)
    for (uint64_t n = 0; n < components; ++n) values[k * components + n] = static_cast<float>(get(k, n));
  file.image("PointData/" + name, values, grid.cells, components);
}

double part(const Vec3& v, uint64_t n) { return n == 0 ? v.x : n == 1 ? v.y : v.z; }

}  // namespace

void write_average_vtkhdf(const std::filesystem::path& path, const CoarseGrid& grid, const AverageFields& f) {
  write_vtkhdf(path, VtkHdfType::image_data, [&](VtkHdfFile& file) {
    const int64_t extent[] = {0, grid.cells[0] - 1, 0, grid.cells[1] - 1, 0, grid.cells[2] - 1};
    const Vec3 first = grid.centre(0);
    const double origin[] = {first.x, first.y, first.z};
    const double spacing[] = {grid.spacing.x, grid.spacing.y, grid.spacing.z};
    const double direction[] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    file.attribute("WholeExtent", extent);
    file.attribute("KernelHalfWidth", std::span(&grid.width, 1));
    file.attribute("Origin", origin), file.attribute("Spacing", spacing), file.attribute("Direction", direction);
    const auto one = [&](const char* name, const std::vector<double>& values) {
      write_field(file, grid, name, 1, [&](size_t k, uint64_t) { return values[k]; });
    };
    const auto vector = [&](const char* name, const std::vector<Vec3>& values) {
      write_field(file, grid, name, 3, [&](size_t k, uint64_t n) { return part(values[k], n); });
    };
    const auto tensor = [&](const char* name, const std::vector<std::array<double, 6>>& values) {
      write_field(file, grid, name, 6, [&](size_t k, uint64_t n) { return values[k][n]; });
    };
    one("solid_fraction", f.solid_fraction), one("bulk_density", f.bulk_density);
    vector("velocity", f.velocity), vector("mass_flux", f.mass_flux);
    one("granular_temperature", f.temperature);
    tensor("stress", f.stress), tensor("kinetic_stress", f.kinetic_stress);
    one("free_share", f.free_share);
  });
}

void write_average(const std::filesystem::path& folder, const std::string& name, const Case& c, const CoarseGrid& grid,
                   const AverageFields& fields) {
  make_folder(folder);
  write_average_vtkhdf(folder / (name + ".vtkhdf"), grid, fields);
  write_average_pictures(folder, name, c, grid, fields);
}

}  // namespace scree
