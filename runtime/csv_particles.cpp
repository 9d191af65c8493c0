#include "runtime/csv_particles.h"

#include "runtime/csv_table.h"

namespace scree {
namespace {

constexpr double kLargestRadius = 5;  // m: more is a slip of the unit

}  // namespace

std::vector<CsvParticle> read_particles_csv(const std::string& path) {
  CsvTable table(path, {"x", "y", "z", "radius", "r", "vx", "vy", "vz", "kind"});
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
    p.position = {table.number(x), table.number(y), table.number(z)};
    p.radius = table.number(radius);
    if (!(p.radius > 0 && p.radius <= kLargestRadius)) {
      table.fail(radius, fmt::format("{} is out of range, must be greater than 0 and at most {} m", table.text(radius),
                                     kLargestRadius));
    }
    if (moving) p.velocity = {table.number(vx), table.number(vy), table.number(vz)};
    if (kind >= 0) p.kind = table.text(kind);
  }
  if (particles.empty()) throw CaseError({path, table.line(), 1}, "the file has no particles below its header");
  return particles;
}

}  // namespace scree
