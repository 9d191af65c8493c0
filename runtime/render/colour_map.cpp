#include "runtime/render/colour_map.h"

#include <span>

namespace scree {

namespace {

// The way of viridis (S. van der Walt and N. Smith, matplotlib) from violet over green to yellow, but beginning at half
// the lightness of white: shading and shadows need room below, or slow grains are black.
constexpr Srgb kSequential[] = {{98, 78, 158},  {78, 104, 178}, {56, 130, 184}, {40, 154, 172}, {46, 176, 146},
                                {92, 196, 110}, {154, 212, 72}, {218, 224, 52}, {255, 236, 96}};
// Blue to red through light grey, of equal lightness at equal distance from the middle (K. Moreland, "Diverging Color
// Maps for Scientific Visualization", 2009).
constexpr Srgb kCoolWarm[] = {{59, 76, 192},   {98, 130, 234},  {141, 176, 254}, {184, 208, 249}, {221, 221, 221},
                              {245, 196, 173}, {244, 154, 123}, {222, 96, 77},   {180, 4, 38}};
// M. Okabe and K. Ito, "Color Universal Design", 2008; its black is a grey here, which keeps its shading.
constexpr Srgb kCategories[] = {{0, 114, 178},  {230, 159, 0}, {0, 158, 115},  {204, 121, 167},
                                {86, 180, 233}, {213, 94, 0},  {240, 228, 66}, {110, 110, 110}};

struct Lab {
  float l, a, b;
};

// Oklab (B. Ottosson, 2020), where a straight line between two colours is even to the eye.
Lab to_lab(const Rgb& c) {
  const float l = std::cbrt(0.4122214708f * c.r + 0.5363325363f * c.g + 0.0514459929f * c.b);
  const float m = std::cbrt(0.2119034982f * c.r + 0.6806995451f * c.g + 0.1073969566f * c.b);
  const float s = std::cbrt(0.0883024619f * c.r + 0.2817188376f * c.g + 0.6299787005f * c.b);
  return {0.2104542553f * l + 0.7936177850f * m - 0.0040720468f * s,
          1.9779984951f * l - 2.4285922050f * m + 0.4505937099f * s,
          0.0259040371f * l + 0.7827717662f * m - 0.8086757660f * s};
}

Rgb from_lab(const Lab& c) {
  const float l = std::pow(c.l + 0.3963377774f * c.a + 0.2158037573f * c.b, 3.0f);
  const float m = std::pow(c.l - 0.1055613458f * c.a - 0.0638541728f * c.b, 3.0f);
  const float s = std::pow(c.l - 0.0894841775f * c.a - 1.2914855480f * c.b, 3.0f);
  return {4.0767416621f * l - 3.3077115913f * m + 0.2309699292f * s,
          -1.2684380046f * l + 2.6097574011f * m - 0.3413193965f * s,
          -0.0041960863f * l - 0.7034186147f * m + 1.7076147010f * s};
}

float distance(const Lab& p, const Lab& q) { return std::hypot(p.l - q.l, p.a - q.a, p.b - q.b); }

// A way through Oklab by its points, walked at an even pace.
class Way {
 public:
  explicit Way(std::span<const Srgb> points) {
    for (const Srgb& c : points) {
      points_.push_back(to_lab(to_linear(c)));
      const size_t k = points_.size() - 1;
      lengths_.push_back(k == 0 ? 0 : lengths_[k - 1] + distance(points_[k - 1], points_[k]));
    }
  }
  Srgb at(double x) const {
    const auto walked = static_cast<float>(std::clamp(x, 0.0, 1.0)) * lengths_.back();
    size_t k = 1;
    while (k + 1 < points_.size() && lengths_[k] < walked) ++k;
    const Lab &p = points_[k - 1], &q = points_[k];
    const float share = (walked - lengths_[k - 1]) / (lengths_[k] - lengths_[k - 1]);
    return to_srgb(from_lab({p.l + share * (q.l - p.l), p.a + share * (q.a - p.a), p.b + share * (q.b - p.b)}));
  }

 private:
  std::vector<Lab> points_;
  std::vector<float> lengths_;  // from the first point
};

}  // namespace

Srgb colour_of(ColourMap map, double x) {
  if (std::isnan(x)) return kNoValue;
  static const Way sequential(kSequential), diverging(kCoolWarm);
  return (map == ColourMap::sequential ? sequential : diverging).at(x);
}

Srgb colour_of_category(size_t index) { return kCategories[index % std::size(kCategories)]; }

Srgb colour_of(const ColourScale& scale, double value) {
  if (std::isnan(value)) return kNoValue;
  if (!scale.categories.empty()) return colour_of_category(static_cast<size_t>(std::max(0.0, value)));
  return colour_of(scale.map, (value - scale.min) / (scale.max - scale.min));
}

}  // namespace scree
