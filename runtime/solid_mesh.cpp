#include "runtime/solid_mesh.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace scree {

namespace {

using std::numbers::pi;

constexpr uint8_t kTriangle = 5, kQuad = 9;  // VTK's numbers
constexpr int kSidesOfRevolution = 64;
constexpr size_t kManyFibres = 10000;

struct Frame {
  Vec3 across, up;  // unit, with the axis a right-handed frame
};

Frame frame_of(const Vec3& axis) {
  const Vec3 other = std::abs(axis.x) < 0.5 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 across = cross(other, axis), unit = (1 / norm(across)) * across;
  return {unit, cross(axis, unit)};
}

class Mesher {
 public:
  Mesher(SolidMesh& mesh, int fibre_sides) : mesh_(mesh), fibre_sides_(fibre_sides) {}

  void add(const Primitive& p, int32_t index) {
    primitive_ = &p, index_ = index;
    std::visit(*this, p.skeleton);
  }

  // A capsule: rings round the axis, ends rounded by two rings and a point each.
  void operator()(const Segment& s) {
    const Vec3 along = s.b - s.a;
    const double length = norm(along), r = primitive_->radius;
    const Vec3 axis = (1 / length) * along;
    constexpr double kAngles[] = {0, pi / 6, pi / 3};
    std::vector<std::vector<int64_t>> rings;
    for (int k = 2; k >= 0; --k)
      rings.push_back(ring(s.a, axis, r * std::cos(kAngles[k]), -r * std::sin(kAngles[k]), fibre_sides_));
    for (int k = 0; k <= 2; ++k)
      rings.push_back(ring(s.a, axis, r * std::cos(kAngles[k]), length + r * std::sin(kAngles[k]), fibre_sides_));
    for (size_t k = 1; k < rings.size(); ++k) join(rings[k - 1], rings[k]);
    fan(point(s.a - r * axis), rings.front());
    fan(point(s.b + r * axis), rings.back());
  }

  void operator()(const Quad& q) {
    std::vector<int64_t> corners;
    for (int k = 0; k < 4; ++k) {
      const Vec3 step = q.corners[k] - q.corners[(k + 3) % 4];
      if (k > 0 && norm(step) == 0) continue;  // a triangle repeats its last corner
      corners.push_back(point(q.corners[k]));
    }
    cell(corners);
  }

  void operator()(const Revolution& v) {
    const auto first = ring(v.base, v.axis, v.r0, v.h0, kSidesOfRevolution);
    const auto last = ring(v.base, v.axis, v.r1, v.h1, kSidesOfRevolution);
    if (first.size() == 1) return fan(first[0], last);
    if (last.size() == 1) return fan(last[0], first);
    join(first, last);
  }

 private:
  int64_t point(const Vec3& x) { return mesh_.grid.add_point(x.x, x.y, x.z); }

  // Points round the axis; one point if r is 0.
  std::vector<int64_t> ring(const Vec3& base, const Vec3& axis, double r, double height, int sides) {
    const Vec3 centre = base + height * axis;
    if (r == 0) return {point(centre)};
    const Frame f = frame_of(axis);
    std::vector<int64_t> points;
    for (int k = 0; k < sides; ++k) {
      const double angle = 2 * pi * k / sides;
      points.push_back(point(centre + (r * std::cos(angle)) * f.across + (r * std::sin(angle)) * f.up));
    }
    return points;
  }
  void join(const std::vector<int64_t>& a, const std::vector<int64_t>& b) {
    for (size_t k = 0; k < a.size(); ++k) {
      const size_t next = (k + 1) % a.size();
      cell({a[k], a[next], b[next], b[k]});
    }
  }
  void fan(int64_t tip, const std::vector<int64_t>& ring) {
    for (size_t k = 0; k < ring.size(); ++k) cell({tip, ring[k], ring[(k + 1) % ring.size()]});
  }
  void cell(const std::vector<int64_t>& corners) {
    mesh_.grid.add_cell(corners.size() == 3 ? kTriangle : kQuad, corners);
    mesh_.wall.push_back(static_cast<int32_t>(primitive_->wall));
    mesh_.primitive.push_back(index_);
    mesh_.radius.push_back(static_cast<float>(primitive_->radius));
  }

  SolidMesh& mesh_;
  int fibre_sides_;
  const Primitive* primitive_ = nullptr;
  int32_t index_ = 0;
};

}  // namespace

SolidMesh mesh_of(const Solid& solid) {
  const size_t fibres = static_cast<size_t>(std::ranges::count_if(
      solid.primitives, [](const Primitive& p) { return std::holds_alternative<Segment>(p.skeleton); }));
  SolidMesh mesh;
  Mesher mesher(mesh, fibres > kManyFibres ? 8 : 16);
  for (size_t k = 0; k < solid.primitives.size(); ++k) mesher.add(solid.primitives[k], static_cast<int32_t>(k));
  return mesh;
}

void write_mesh(VtkHdfFile& file, const SolidMesh& mesh) {
  write_grid(file, mesh.grid);
  file.array("CellData/wall", std::span<const int32_t>(mesh.wall));
  file.array("CellData/primitive", std::span<const int32_t>(mesh.primitive));
  file.array("CellData/fibre_radius", std::span<const float>(mesh.radius));
}

}  // namespace scree
