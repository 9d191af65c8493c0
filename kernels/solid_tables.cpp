#include "kernels/solid_tables.h"

#include "geometry/bounds.h"

namespace scree {

namespace {

Primitive shifted(Primitive p, const Vec3& by) {
  std::visit(
      [&](auto& s) {
        using S = std::decay_t<decltype(s)>;
        if constexpr (std::is_same_v<S, Segment>)
          s.a += by, s.b += by;
        else if constexpr (std::is_same_v<S, Quad>)
          for (Vec3& c : s.corners) c += by;
        else
          s.base += by;
      },
      p.skeleton);
  return p;
}

bool overlaps(const Bounds& a, const Bounds& b) {
  return a.min.x <= b.max.x && b.min.x <= a.max.x && a.min.y <= b.max.y && b.min.y <= a.max.y && a.min.z <= b.max.z &&
         b.min.z <= a.max.z;
}

constexpr double kFar = 1e6;  // m, where padding lanes' primitives lie

template <class Real, class Tables>
void add_row(Tables& t, const Primitive& p, const SolidSurface<Real>& surface, uint32_t id) {
  std::visit(
      [&](const auto& s) {
        using S = std::decay_t<decltype(s)>;
        if constexpr (std::is_same_v<S, Segment>)
          t.segments.add({prepared(s), p.radius}, surface, id);
        else if constexpr (std::is_same_v<S, Quad>)
          t.quads.add({prepared(s), p.radius}, surface, id);
        else
          t.revolutions.add({prepared(s), p.radius}, surface, id);
      },
      p.skeleton);
}

}  // namespace

ImagedSolid with_periodic_images(const Solid& solid, const Bounds& box, const bool (&periodic)[3], double reach) {
  ImagedSolid result{solid, {}};
  for (uint32_t k = 0; k < solid.primitives.size(); ++k) result.identity.push_back(k);
  const Vec3 length = box.max - box.min;
  const Bounds wanted = inflated(box, reach);
  for (int sx = -1; sx <= 1; ++sx)
    for (int sy = -1; sy <= 1; ++sy)
      for (int sz = -1; sz <= 1; ++sz) {
        if ((sx == 0 && sy == 0 && sz == 0) || (sx != 0 && !periodic[0]) || (sy != 0 && !periodic[1]) ||
            (sz != 0 && !periodic[2]))
          continue;
        const Vec3 by{sx * length.x, sy * length.y, sz * length.z};
        for (uint32_t k = 0; k < solid.primitives.size(); ++k) {
          const Primitive image = shifted(solid.primitives[k], by);
          if (!overlaps(bounds_of(image), wanted)) continue;
          result.solid.primitives.push_back(image);
          result.identity.push_back(k);
        }
      }
  return result;
}

template <class Real>
SolidTables<Real> make_solid_tables(const ImagedSolid& imaged, uint32_t kinds) {
  SolidTables<Real> t;
  const auto& primitives = imaged.solid.primitives;
  for (size_t k = 0; k < primitives.size(); ++k) {
    const Primitive& p = primitives[k];
    const int kind = static_cast<int>(p.skeleton.index());
    const size_t row = kind == 0 ? t.segments.rows.size() : kind == 1 ? t.quads.rows.size() : t.revolutions.rows.size();
    t.kind.push_back(static_cast<uint8_t>(kind));
    t.row.push_back(static_cast<uint32_t>(row));
    const Vec<Real> v{static_cast<Real>(p.velocity.x), static_cast<Real>(p.velocity.y),
                      static_cast<Real>(p.velocity.z)};
    add_row<Real>(t, p, {v, kinds + p.material}, imaged.identity[k]);
  }
  const Vec3 far{kFar, kFar, kFar};
  const SolidSurface<Real> still{{0, 0, 0}, kinds};
  add_row<Real>(t, {Segment{far, far + Vec3{1, 0, 0}}}, still, 0);
  add_row<Real>(t, {Quad{{far, far + Vec3{1, 0, 0}, far + Vec3{1, 1, 0}, far + Vec3{0, 1, 0}}}}, still, 0);
  add_row<Real>(t, {Revolution{far, {0, 0, 1}, 1, 0, 1, 1}}, still, 0);
  return t;
}

template SolidTables<float> make_solid_tables(const ImagedSolid&, uint32_t);
template SolidTables<double> make_solid_tables(const ImagedSolid&, uint32_t);

}  // namespace scree
