#include "geometry/closest_point.h"
#include "geometry/solid_index.h"

namespace scree {

namespace {

class BruteForceIndex final : public SolidIndex {
 public:
  explicit BruteForceIndex(const Solid& solid) {
    for (const Primitive& primitive : solid.primitives) primitives_.push_back(prepared(primitive));
  }

  void query(const Vec3& x, double reach, std::vector<uint32_t>& found) const override {
    for (uint32_t k = 0; k < primitives_.size(); ++k)
      if (distance(primitives_[k], x) <= reach) found.push_back(k);
  }

 private:
  std::vector<PreparedPrimitive> primitives_;
};

}  // namespace

std::unique_ptr<SolidIndex> make_brute_force_index(const Solid& solid) {
  return std::make_unique<BruteForceIndex>(solid);
}

}  // namespace scree
