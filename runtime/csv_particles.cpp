#include "runtime/csv_particles.h"

#include "runtime/csv_table.h"

namespace scree {
namespace {

constexpr Range kRadius = between(5e-8, 5, "m");  // beyond it is a slip of the unit
const std::vector<std::string> kColumns{"x", "y", "z", "radius", "r", "vx", "vy", "vz", "kind"};

std::vector<CsvParticle> read_rows(CsvTable& table, const std::string& path) {
  const int x = table.require("x"), y = table.require("y"), z = table.require("z");
  const int short_radius = table.column("r"), kind = table.column("kind");
  const int radius = short_radius >= 0 ? short_radius : table.require("radius");
  if (short_radius >= 0 && table.column("radius") >= 0) {
    table.fail(table.column("radius"), "the radius is there twice, as 'r' and as 'radius'");
  }
  const bool moving = table.column("vx") >= 0 || table.column("vy") >= 0 || table.column("vz") >= 0;
  const int vx = moving ? table.require("vx") : -1, vy = moving ? table.require("vy") : -1;
  const int vz = moving ? table.require("vz") : -1;
  std::vector<CsvParticle> particles;
  while (table.next()) {
    CsvParticle& p = particles.emplace_back();
    p.line = table.line();
    p.position = {table.number(x, kPosition), table.number(y, kPosition), table.number(z, kPosition)};
    p.radius = table.number(radius, kRadius);
    if (moving) p.velocity = {table.number(vx, kVelocity), table.number(vy, kVelocity), table.number(vz, kVelocity)};
    if (kind >= 0) p.kind = table.text(kind);
  }
  if (particles.empty()) throw CaseError({path, table.line(), 1}, "the file has no particles below its header");
  return particles;
}

}  // namespace

std::vector<CsvParticle> read_particles_csv(const std::string& path) {
  CsvTable table(path, kColumns);
  return read_rows(table, path);
}

std::vector<CsvParticle> read_particles_csv(const std::string& path, std::string text) {
  CsvTable table(path, std::move(text), kColumns);
  return read_rows(table, path);
}

}  // namespace scree
