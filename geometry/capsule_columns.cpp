#include "geometry/capsule_columns.h"

#include <algorithm>
#include <limits>

#include "geometry/closest_point.h"
#include "geometry/fuzzing.h"

namespace scree {

namespace {

constexpr double kBins = kFuzzing ? 16 : 10000;  // about so many, about square, across the box
constexpr int kColumns =
    kFuzzing ? 1 << 4 : 1 << 18;  // error about 1/kColumns times the roughness of the projection; see porosity.h

// Coordinates turned cyclically, so that the box stays right-handed, until its longest edge is z.
Vec3 turned(const Vec3& v, int longest) {
  return longest == 2 ? v : longest == 0 ? Vec3{v.y, v.z, v.x} : Vec3{v.z, v.x, v.y};
}

int longest_axis(const Bounds& box) {
  const Vec3 size = box.max - box.min;
  return size.z >= size.x && size.z >= size.y ? 2 : size.x >= size.y ? 0 : 1;
}

constexpr CapsuleColumns::Interval kNothing{std::numeric_limits<double>::infinity(),
                                            -std::numeric_limits<double>::infinity()};

double fraction_of(double a) { return a - std::floor(a); }

// Widens the interval to cover centre +- half.
void widen(CapsuleColumns::Interval& interval, double centre, double half) {
  interval.begin = std::min(interval.begin, centre - half);
  interval.end = std::max(interval.end, centre + half);
}

}  // namespace

CapsuleColumns::CapsuleColumns(std::span<const Segment> axes, double radius, const Bounds& box) : radius_(radius) {
  const int longest = longest_axis(box);
  box_ = {turned(box.min, longest), turned(box.max, longest)};
  make_bins();
  for (const Segment& axis : axes) {
    const Vec3 a = turned(axis.a, longest), b = turned(axis.b, longest);
    const double length = norm(b - a);
    capsules_.push_back({a, b, length > 0 ? (1 / length) * (b - a) : Vec3{0, 0, 0}, length});
    add_to_bins(uint32_t(capsules_.size() - 1));
  }
}

void CapsuleColumns::make_bins() {
  const Vec3 size = box_.max - box_.min;
  const double width = std::sqrt(size.x * size.y / kBins);
  bins_x_ = int(std::clamp(size.x / width, 1.0, kBins));
  bins_y_ = int(std::clamp(size.y / width, 1.0, kBins));
  bin_width_x_ = size.x / bins_x_;
  bin_width_y_ = size.y / bins_y_;
  bins_.resize(size_t(bins_x_) * bins_y_);
}

int CapsuleColumns::bin_x(double x) const {
  return int(std::clamp((x - box_.min.x) / bin_width_x_, 0.0, bins_x_ - 1.0));
}

int CapsuleColumns::bin_y(double y) const {
  return int(std::clamp((y - box_.min.y) / bin_width_y_, 0.0, bins_y_ - 1.0));
}

// A bin takes the capsule if the bin's circumscribed circle touches the capsule's shadow.
void CapsuleColumns::add_to_bins(uint32_t index) {
  const Vec3 a{capsules_[index].a.x, capsules_[index].a.y, 0}, b{capsules_[index].b.x, capsules_[index].b.y, 0};
  const SegmentOf<double> shadow = prepared(Segment{a, b});
  const double reach = radius_ + 0.5001 * std::hypot(bin_width_x_, bin_width_y_);
  const int i0 = bin_x(std::min(a.x, b.x) - reach), i1 = bin_x(std::max(a.x, b.x) + reach);
  const int j0 = bin_y(std::min(a.y, b.y) - reach), j1 = bin_y(std::max(a.y, b.y) + reach);
  for (int j = j0; j <= j1; ++j) {
    for (int i = i0; i <= i1; ++i) {
      const Vec3 centre{box_.min.x + (i + 0.5) * bin_width_x_, box_.min.y + (j + 0.5) * bin_width_y_, 0};
      if (norm(centre - closest_on(shadow, centre)) <= reach) bin(i, j).push_back(index);
    }
  }
}

// A capsule is convex, so the column meets it in one interval, whose ends lie on a cap or on the mantle: the hull of
// its two cap intervals and of those roots of |w|^2 - (w.n)^2 = r^2 (w from a, n the direction) that fall between the
// caps.
CapsuleColumns::Interval CapsuleColumns::covered(const Capsule& capsule, double x, double y) const {
  Interval result = kNothing;
  const double radius2 = radius_ * radius_;
  for (const Vec3& end : {capsule.a, capsule.b}) {
    const double off2 = (x - end.x) * (x - end.x) + (y - end.y) * (y - end.y);
    if (off2 < radius2) widen(result, end.z, std::sqrt(radius2 - off2));
  }
  const Vec3& n = capsule.direction;
  const double across2 = n.x * n.x + n.y * n.y;
  if (across2 < 1e-14) return result;  // along the column: the caps say all
  const double wx = x - capsule.a.x, wy = y - capsule.a.y;
  const double sideways = (wx * n.y - wy * n.x);  // times 1/sqrt(across2): distance between column and axis
  const double discriminant = radius2 * across2 - sideways * sideways;
  if (discriminant < 0) return result;
  const double nearest = (wx * n.x + wy * n.y) / across2;  // along the axis, where the column passes it
  const double half = std::sqrt(discriminant) / across2;   // between there and the roots, along the column
  for (const double step : {-half, half}) {
    const double along = nearest + step * n.z;
    if (along >= 0 && along <= capsule.length) widen(result, capsule.a.z + nearest * n.z + step, 0);
  }
  return result;
}

double CapsuleColumns::covered_length(double x, double y, std::vector<Interval>& scratch) const {
  scratch.clear();
  for (const uint32_t index : bins_[size_t(bin_y(y)) * bins_x_ + bin_x(x)]) {
    const Interval interval = covered(capsules_[index], x, y);
    if (interval.begin < interval.end) scratch.push_back(interval);
  }
  std::ranges::sort(scratch, {}, &Interval::begin);
  double length = 0, reached = box_.min.z;
  for (const Interval& interval : scratch) {
    const double end = std::min(interval.end, box_.max.z);
    length += std::max(0.0, end - std::max(interval.begin, reached));
    reached = std::max(reached, end);
  }
  return length;
}

// Columns stand on the two-dimensional Kronecker sequence of the plastic number p (p^3 = p + 1), the evenest known
// of its kind; unlike a grid it lines up with no family of fibres. Source: M. Roberts, "The Unreasonable Effectiveness
// of Quasirandom Sequences" (2018).
double CapsuleColumns::solid_fraction() const {
  constexpr double kPlastic = 1.32471795724474602596;
  const Vec3 size = box_.max - box_.min;
  std::vector<Interval> scratch;
  double total = 0;
  for (int k = 0; k < kColumns; ++k) {
    const double x = box_.min.x + size.x * fraction_of(0.5 + k / kPlastic);
    const double y = box_.min.y + size.y * fraction_of(0.5 + k / (kPlastic * kPlastic));
    total += covered_length(x, y, scratch);
  }
  return total / kColumns / size.z;
}

}  // namespace scree
