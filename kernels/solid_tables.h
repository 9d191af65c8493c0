// The solid in the form that the contact loops read: one table of prepared primitives per kind of skeleton.
#pragma once

#include <cstdint>
#include <tuple>
#include <vector>

#include "kernels/chunk_task.h"

namespace scree {

template <template <class> class Skeleton, class Real>
struct SkeletonRows {
  std::vector<Rounded<Skeleton, double>> rows;
  std::vector<SolidSurface<Real>> surface;
  std::vector<uint32_t> identity;  // index in the solid's list of primitives before periodic images were added

  uint32_t dummy() const { return static_cast<uint32_t>(rows.size() - 1); }
  SkeletonTable<Skeleton, Real> view() const { return {rows.data(), surface.data()}; }
  void add(const Rounded<Skeleton, double>& row, const SolidSurface<Real>& s, uint32_t id) {
    rows.push_back(row), surface.push_back(s), identity.push_back(id);
  }
};

template <class Real>
struct SolidTables {
  SkeletonRows<SegmentOf, Real> segments;
  SkeletonRows<QuadOf, Real> quads;
  SkeletonRows<RevolutionOf, Real> revolutions;
  std::vector<uint8_t> kind;  // of each primitive in the (imaged) solid: 0 segment, 1 quad, 2 revolution
  std::vector<uint32_t> row;  // its row in that kind's table

  uint32_t identity(int k, uint32_t r) const {
    return k == 0 ? segments.identity[r] : k == 1 ? quads.identity[r] : revolutions.identity[r];
  }
};

// The solid with copies across periodic borders of what reaches within `reach` (m) of them. `identity[k]` is the
// original's index. An infinite wall along a periodic axis needs no copies: give it as long as the box and it gets
// them.
struct ImagedSolid {
  Solid solid;
  std::vector<uint32_t> identity;
};
ImagedSolid with_periodic_images(const Solid& solid, const Bounds& box, const bool (&periodic)[3], double reach);

// `kinds` particle kinds come before the wall materials in the columns of the material table.
template <class Real>
SolidTables<Real> make_solid_tables(const ImagedSolid& imaged, uint32_t kinds);

extern template SolidTables<float> make_solid_tables(const ImagedSolid&, uint32_t);
extern template SolidTables<double> make_solid_tables(const ImagedSolid&, uint32_t);

}  // namespace scree
