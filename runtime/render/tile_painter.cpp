#include "runtime/render/tile_painter.h"

#include <algorithm>
#include <numbers>

namespace scree {

namespace {

// The light. Key and ambient together light a surface that faces the key light fully to its own colour, so that colours
// compare with the colour bar's.
constexpr float kKey = 0.60f, kAmbient = 0.68f;
constexpr float kBounced = 0.2f;       // of the ambient light, where it is kept out: other surfaces send it on
constexpr float kLightSpread = 0.16f;  // radius of the key light as seen from the scene, rad: the softness of shadows
constexpr float kGround = 0.55f;       // light from below, of that from above
// To the light and round a fibre's surface, a pixel, at least. Fibres are wide, smooth and light: of as few rays as a
// run's own pictures have samples, shadow or none of each would be a grain of light and dark pixels on them. Balls are
// small and have edges enough.
constexpr int kFibreRays = 32;
constexpr float kReachInBalls = 6, kReachInFibres = 4;  // kReach, in radii
constexpr Rgb kMetal{0.47f, 0.48f, 0.50f}, kCutMetal{0.17f, 0.18f, 0.20f};
constexpr float kMetalShine = 0.35f, kBallShine = 0.04f, kShininess = 30;
// Walls and their edges: how much of the colour behind they replace, and by what.
constexpr Rgb kGlass{0.45f, 0.60f, 0.75f}, kEdge{0.10f, 0.14f, 0.20f};
constexpr float kGlassShare[] = {0.07f, 0.03f}, kEdgeShare[] = {0.45f, 0.25f};  // by WallStyle
constexpr float kEdgePixels = 0.7f;  // half the width of an edge in a picture 1080 high

Vec3f to_float(const Vec3& v) { return {float(v.x), float(v.y), float(v.z)}; }
Vec3f unit(const Vec3f& v) { return (1 / std::sqrt(dot(v, v))) * v; }

// Two numbers in [0, 1) that differ from pixel to pixel without a visible pattern (a hash of the place).
struct Pair {
  float u, v;
};
Pair noise(uint32_t x, uint32_t y, uint32_t which) {
  uint64_t h = (uint64_t{x} << 32 | y) * 0x9e3779b97f4a7c15ull + which * 0xd1b54a32d192ed03ull;
  h = (h ^ (h >> 32)) * 0xd6e8feb86659fd93ull;
  h = (h ^ (h >> 32)) * 0xd6e8feb86659fd93ull;
  h ^= h >> 32;
  return {static_cast<float>(h & 0xffffff) * 0x1p-24f, static_cast<float>((h >> 24) & 0xffffff) * 0x1p-24f};
}

// The k-th of n points that cover the unit square evenly (Hammersley).
Pair spread(uint32_t k, uint32_t n) {
  uint32_t bits = k;
  bits = (bits << 16) | (bits >> 16);
  bits = ((bits & 0x00ff00ffu) << 8) | ((bits & 0xff00ff00u) >> 8);
  bits = ((bits & 0x0f0f0f0fu) << 4) | ((bits & 0xf0f0f0f0u) >> 4);
  bits = ((bits & 0x33333333u) << 2) | ((bits & 0xccccccccu) >> 2);
  bits = ((bits & 0x55555555u) << 1) | ((bits & 0xaaaaaaaau) >> 1);
  return {(static_cast<float>(k) + 0.5f) / static_cast<float>(n), static_cast<float>(bits >> 8) * 0x1p-24f};
}
Pair shifted(const Pair& a, const Pair& by) {
  const auto wrap = [](float x) { return x < 1 ? x : x - 1; };
  return {wrap(a.u + by.u), wrap(a.v + by.v)};
}

// Evenly over a disc of radius 1.
Pair on_disc(const Pair& p) {
  const float r = std::sqrt(p.u), angle = 2 * std::numbers::pi_v<float> * p.v;
  return {r * std::cos(angle), r * std::sin(angle)};
}

// A direction round the normal, as often as its cosine: what light from all round is weighted with.
Vec3f round_normal(const Vec3f& n, const Pair& p) {
  const Vec3f start = std::abs(n.x) < 0.6f ? Vec3f{1, 0, 0} : Vec3f{0, 1, 0};
  const Vec3f u = unit(cross(n, start)), v = cross(n, u);
  const Pair d = on_disc(p);
  return d.u * u + d.v * v + std::sqrt(std::max(0.0f, 1 - d.u * d.u - d.v * d.v)) * n;
}

std::vector<Capsule> lines(const std::vector<Segment>& edges, double radius) {
  std::vector<Capsule> capsules;
  for (const Segment& edge : edges) capsules.push_back({edge, radius});
  return capsules;
}

double mean_radius(const auto& bodies) {
  double sum = 0;
  for (const auto& body : bodies) sum += body.radius;
  return bodies.empty() ? 0 : sum / static_cast<double>(bodies.size());
}

// How far behind its target an orthographic eye is, m: a plane that everything is in front of.
double in_front_of_all(const Scene& scene, const Camera& camera) {
  double back = 0;
  const auto include = [&](const Vec3& x, double radius) { back = std::max(back, norm(x - camera.target) + radius); };
  for (const Ball& b : scene.balls) include(b.centre, b.radius);
  for (const Capsule& c : scene.fibres) include(c.axis.a, c.radius), include(c.axis.b, c.radius);
  for (const Quad& q : scene.walls)
    for (const Vec3& corner : q.corners) include(corner, 0);
  return 1.01 * back;
}

// to_linear() of each byte: a power is too much for each ray.
const std::array<float, 256> kLinear = [] {
  std::array<float, 256> linear{};
  for (size_t k = 0; k < linear.size(); ++k) linear[k] = to_linear(static_cast<float>(k) / 255.0f);
  return linear;
}();
Rgb linear_of(const Srgb& c) { return {kLinear[c[0]], kLinear[c[1]], kLinear[c[2]]}; }

}  // namespace

struct TilePainter::Tile {
  int x0, y0, columns, rows;
  std::vector<Ray> rays;  // a sample each, pixel by pixel; far: to where the solid is hit
  std::vector<const Cut*> cut_by;
  std::vector<Hit> hits;
  std::vector<Surface> surfaces;
  std::vector<Rgb> colours;  // a sample each
};

TilePainter::TilePainter(Scene scene, const Camera& camera, const PictureSize& size, int samples)
    : ball_colours_(std::move(scene.ball_colours)),
      wall_style_(scene.wall_style),
      camera_(camera),
      size_(size),
      samples_(samples),
      solid_tiles_(camera, size, kTile),
      glass_tiles_(camera, size, kTile) {
  for (const Ball& ball : scene.balls) solid_tiles_.add(ball);
  for (const Capsule& fibre : scene.fibres) solid_tiles_.add(fibre);
  const double back = camera.distance > 0 ? camera.distance : in_front_of_all(scene, camera);
  const double ball = mean_radius(scene.balls), fibre = mean_radius(scene.fibres);
  reach_ = static_cast<float>(std::max(kReachInBalls * ball, kReachInFibres * fibre));
  start_ = static_cast<float>(1e-3 * (ball > 0 ? ball : fibre));

  solid_ = make_embree_tracer({std::move(scene.balls), std::move(scene.fibres), {}});
  const double pixel = camera.height / size.height;
  if (scene.wall_style != WallStyle::hidden && !scene.walls.empty()) {
    const double edge = kEdgePixels * pixel * std::max(1.0, size.height / 1080.0);
    std::vector<Capsule> edges = lines(scene.wall_edges, edge);
    for (const Capsule& line : edges) glass_tiles_.add(line);
    for (const Quad& wall : scene.walls) glass_tiles_.add(wall);
    glass_ = make_embree_tracer({{}, std::move(edges), std::move(scene.walls)});
    glass_shift_ = to_float(solid_->origin() - glass_->origin());
  }
  step_right_ = to_float(pixel * camera.right), step_down_ = to_float(-pixel * camera.up);
  forward_ = to_float(camera.forward);
  eye_ = solid_->local(camera.target - back * camera.forward);
  const Vec3 to_light = scree::unit(-0.45 * camera.right + 0.80 * camera.up - 0.75 * camera.forward);
  to_light_ = to_float(to_light);
  light_u_ = to_float(perpendicular_to(to_light)), light_v_ = cross(to_light_, light_u_);
  sky_ = to_float(scree::unit(camera.up - 0.5 * camera.forward));
  for (const CutPlane& cut : scene.cuts)
    cuts_.push_back({to_float(cut.normal), static_cast<float>(cut.offset - dot(cut.normal, solid_->origin()))});
}

Ray TilePainter::eye_ray(double x, double y) const {
  const auto right = static_cast<float>(x - 0.5 * size_.width), down = static_cast<float>(y - 0.5 * size_.height);
  const Vec3f across = right * step_right_ + down * step_down_;
  if (camera_.distance == 0) return {eye_ + across, 0, forward_};
  return {eye_, 0, unit(across + static_cast<float>(camera_.distance) * forward_)};
}

bool TilePainter::clip(Ray& ray, const Cut*& entered_by) const {
  for (const Cut& cut : cuts_) {
    const float beyond = dot(cut.normal, ray.origin) - cut.offset, rate = dot(cut.normal, ray.direction);
    if (std::abs(rate) < 1e-9f) {
      if (beyond > 0) return false;
    } else if (rate > 0) {
      ray.far = std::min(ray.far, -beyond / rate);
    } else if (-beyond / rate > ray.near) {
      ray.near = -beyond / rate, entered_by = &cut;
    }
  }
  return ray.near <= ray.far;
}

void TilePainter::leave(Ray& ray) const {
  for (const Cut& cut : cuts_) {
    const float beyond = dot(cut.normal, ray.origin) - cut.offset, rate = dot(cut.normal, ray.direction);
    if (rate > 0) ray.far = std::clamp(-beyond / rate, 0.0f, ray.far);
  }
}

TilePainter::Surface TilePainter::surface_at(const Ray& ray, const BodyId& body, float distance) const {
  const Vec3f point = point_at(ray, distance);
  const bool ball = body.shape == Shape::ball;
  return {point,
          solid_->normal(body, point),
          -ray.direction,
          ball ? linear_of(ball_colours_[body.index]) : kMetal,
          ball ? kBallShine : kMetalShine,
          !ball,
          0};
}

void TilePainter::cast(Tile& tile) const {
  for (int y = tile.y0; y < tile.y0 + tile.rows; ++y)
    for (int x = tile.x0; x < tile.x0 + tile.columns; ++x)
      for (int s = 0; s < samples_; ++s) {
        const Pair p = spread(static_cast<uint32_t>(s), static_cast<uint32_t>(samples_));
        Ray ray = eye_ray(x + p.u, y + p.v);
        const Cut* entered_by = nullptr;
        if (!clip(ray, entered_by)) ray.far = -1;  // meets nothing
        tile.rays.push_back(ray), tile.cut_by.push_back(entered_by);
      }
}

void TilePainter::find_surfaces(Tile& tile) const {
  tile.hits.resize(tile.rays.size());
  solid_->closest(tile.rays, tile.hits);
  for (uint32_t k = 0; k < tile.rays.size(); ++k) {
    Ray& ray = tile.rays[k];
    if (!(ray.near <= ray.far)) continue;
    Surface surface;
    if (tile.cut_by[k]) {
      if (const auto body = solid_->containing(point_at(ray, ray.near))) {  // the cut's flat face
        surface = surface_at(ray, *body, ray.near);
        surface.normal = tile.cut_by[k]->normal;
        if (body->shape == Shape::capsule) surface.colour = kCutMetal, surface.shine = 0;
        surface.sample = k, ray.far = ray.near;
        tile.surfaces.push_back(surface);
        continue;
      }
    }
    const Hit& hit = tile.hits[k];
    if (hit.body.shape == Shape::none) continue;
    surface = surface_at(ray, hit.body, hit.distance);
    surface.sample = k, ray.far = hit.distance;
    tile.surfaces.push_back(surface);
  }
}

void TilePainter::light(Tile& tile) const {
  const size_t n = tile.surfaces.size();
  std::vector<Ray> to_light, around;
  to_light.reserve(n), around.reserve(n);
  const auto rays_of = [&](const Surface& s) {
    return s.is_fibre ? static_cast<uint32_t>((kFibreRays + samples_ - 1) / samples_) : 1u;
  };
  for (const Surface& s : tile.surfaces) {
    const uint32_t rays = rays_of(s);
    const uint32_t pixel = s.sample / samples_, sample = s.sample % samples_;
    const uint32_t x = tile.x0 + pixel % tile.columns, y = tile.y0 + pixel / tile.columns;
    const Vec3f start = s.point + start_ * s.normal;
    for (uint32_t r = 0; r < rays; ++r) {
      const Pair even = spread(sample * rays + r, static_cast<uint32_t>(samples_) * rays);
      const Pair disc = on_disc(shifted(even, noise(x, y, 1)));
      Ray ray{start, 0, unit(to_light_ + kLightSpread * (disc.u * light_u_ + disc.v * light_v_))};
      leave(ray);
      to_light.push_back(ray);
      ray = {start, 0, round_normal(s.normal, shifted(even, noise(x, y, 2))), reach_};
      leave(ray);
      around.push_back(ray);
    }
  }
  std::vector<uint8_t> shadowed(to_light.size()), covered(to_light.size());
  solid_->any(to_light, shadowed);
  solid_->any(around, covered);
  size_t ray = 0;  // the surface's first
  for (const Surface& s : tile.surfaces) {
    float lit = 0, open = 0;  // shares of its rays
    const uint32_t rays = rays_of(s);
    for (uint32_t r = 0; r < rays; ++r, ++ray) lit += !shadowed[ray], open += !covered[ray];
    lit /= static_cast<float>(rays), open /= static_cast<float>(rays);
    const float facing = std::max(0.0f, dot(s.normal, to_light_));
    const float key = lit * kKey * facing;
    const float up = 0.5f + 0.5f * dot(s.normal, sky_);
    const float ambient = (kBounced + (1 - kBounced) * open) * kAmbient * (kGround + (1 - kGround) * up);
    const float gleam = std::pow(std::max(0.0f, dot(s.normal, unit(to_light_ + s.view))), kShininess);
    const float shine = facing == 0 ? 0 : lit * s.shine * gleam;
    tile.colours[s.sample] = (key + ambient) * s.colour + shine * Rgb{1, 1, 1};
  }
}

void TilePainter::lay_walls_over(Tile& tile) const {
  std::vector<Ray> rays = tile.rays;
  for (Ray& ray : rays) ray.origin += glass_shift_;
  std::vector<Crossing> crossings;
  glass_->all(rays, crossings);
  const int style = wall_style_ == WallStyle::transparent ? 0 : 1;
  for (size_t k = crossings.size(); k-- > 0;) {  // from the farthest of each ray
    const Crossing& c = crossings[k];
    Rgb& colour = tile.colours[c.ray];
    if (c.hit.body.shape == Shape::capsule) {
      colour = mix(colour, kEdge, kEdgeShare[style]);
      continue;
    }
    const Ray& ray = rays[c.ray];
    const float cosine = std::abs(dot(glass_->normal(c.hit.body, point_at(ray, c.hit.distance)), ray.direction));
    colour = mix(colour, kGlass, std::min(0.5f, kGlassShare[style] / std::max(cosine, 0.05f)));
  }
}

void TilePainter::paint(Image& image, int x0, int y0) const {
  Tile tile{x0, y0, std::min(kTile, size_.width - x0), std::min(kTile, size_.height - y0), {}, {}, {}, {}, {}};
  const bool solid = solid_tiles_.at(x0, y0), glass = glass_ && glass_tiles_.at(x0, y0);
  if (!solid && !glass) {
    image.fill(x0, y0, x0 + tile.columns, y0 + tile.rows, to_srgb(kBackground));
    return;
  }
  cast(tile);
  tile.colours.assign(tile.rays.size(), kBackground);
  if (solid) find_surfaces(tile), light(tile);
  if (glass) lay_walls_over(tile);
  for (int y = 0; y < tile.rows; ++y)
    for (int x = 0; x < tile.columns; ++x) {
      Rgb sum;
      const size_t first = size_t(y * tile.columns + x) * samples_;
      for (int s = 0; s < samples_; ++s) {
        const Rgb& c = tile.colours[first + s];
        sum = sum + Rgb{std::min(c.r, 1.0f), std::min(c.g, 1.0f), std::min(c.b, 1.0f)};
      }
      image.set(x0 + x, y0 + y, to_srgb(1.0f / static_cast<float>(samples_) * sum));
    }
}

}  // namespace scree
