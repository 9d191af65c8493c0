// Pictures of scenes whose geometry is known.
#include <gtest/gtest.h>

#include <numbers>
#include <set>

#include "kernels/parallel.h"
#include "runtime/render/annotations.h"
#include "runtime/render/case_scene.h"
#include "runtime/render/picture.h"
#include "runtime/render/quantity.h"
#include "runtime/render/text.h"
#include "runtime/render/ticks.h"

namespace scree {
namespace {

constexpr PictureSize kSize{160, 120};
constexpr Srgb kRed{231, 89, 89}, kGreen{89, 218, 89};

// Along +y, 0.12 m high: a pixel is a millimetre.
Camera millimetres() {
  Camera camera;
  camera.height = 0.12;
  return camera;
}

Scene scene_of(std::vector<Ball> balls, const Srgb& colour = kRed) {
  Scene scene;
  scene.balls = std::move(balls);
  scene.ball_colours.assign(scene.balls.size(), colour);
  return scene;
}

bool is_background(const Srgb& c) { return c == to_srgb(kBackground); }
bool is_reddish(const Srgb& c) { return c[0] > 2 * c[1] && c[0] > 2 * c[2]; }
bool is_greenish(const Srgb& c) { return c[1] > 2 * c[0] && c[1] > 2 * c[2]; }
bool is_grey(const Srgb& c) { return !is_background(c) && std::abs(c[0] - c[1]) < 20 && std::abs(c[1] - c[2]) < 20; }

TEST(Picture, ABallCoversThePixelsThatItProjectsTo) {
  const double x = 0.013, z = -0.021, radius = 0.02;
  const Image image = render(scene_of({{{x, 0.5, z}, radius}}), millimetres(), kSize);
  for (int row = 0; row < kSize.height; ++row)
    for (int column = 0; column < kSize.width; ++column) {
      const double from_centre = std::hypot((column + 0.5 - 80) * 1e-3 - x, (60 - row - 0.5) * 1e-3 - z);
      const Srgb seen = image.at(column, row);
      EXPECT_TRUE(from_centre > radius - 1.5e-3 || is_reddish(seen)) << column << ' ' << row;
      EXPECT_TRUE(from_centre < radius + 1.5e-3 || is_background(seen)) << column << ' ' << row;
    }
}

// A pixel half of which the ball covers is half of its colour: what antialiasing is for.
TEST(Picture, TheCoveredAreaIsThatOfTheDisc) {
  Scene scene = scene_of({{{0, 0, 0}, 0.0205}}, {0, 0, 0});
  const Image image = render(scene, millimetres(), kSize, 16);
  const float white = kBackground.r;
  double covered = 0;
  for (int row = 0; row < kSize.height; ++row)
    for (int column = 0; column < kSize.width; ++column)
      covered += 1 - std::min(1.0f, to_linear(image.at(column, row)).r / white);
  EXPECT_NEAR(covered, std::numbers::pi * 20.5 * 20.5, 0.04 * std::numbers::pi * 20.5 * 20.5);  // less the gleam
}

TEST(Picture, APerspectiveBallHasTheSizeOfItsDistance) {
  Camera camera = millimetres();
  camera.distance = 0.5;
  const double radius = 0.02, tangent = radius / std::sqrt(1 - std::pow(radius / 1.0, 2));  // seen from 1 m
  const Image image = render(scene_of({{{0, 0.5, 0}, radius}}), camera, kSize);
  int wide = 0;
  for (int column = 0; column < kSize.width; ++column) wide += !is_background(image.at(column, 60));
  EXPECT_NEAR(wide, 2 * tangent * 0.5 / 1e-3, 2);
}

TEST(Picture, AFibreHidesTheBallBehindIt) {
  Scene scene = scene_of({{{0, 0, 0}, 0.03}});
  scene.fibres = {{{{-0.05, -0.06, 0}, {0.05, -0.06, 0}}, 0.008}};
  const Image image = render(scene, millimetres(), kSize);
  EXPECT_TRUE(is_grey(image.at(80, 60)));
  EXPECT_TRUE(is_reddish(image.at(80, 60 + 20)));
  scene.fibres[0].axis = {{-0.05, 0.06, 0}, {0.05, 0.06, 0}};  // behind
  const Image behind = render(scene, millimetres(), kSize);
  EXPECT_TRUE(is_reddish(behind.at(80, 60)));
  EXPECT_TRUE(is_grey(behind.at(80 + 45, 60)));
}

TEST(Picture, ABallBetweenItAndTheLightShadesAnother) {
  const Camera camera = millimetres();
  const Vec3 to_light = unit(-0.45 * camera.right + 0.80 * camera.up - 0.75 * camera.forward);
  Scene scene = scene_of({{{0, 0, 0}, 0.02}});
  const Vec3 lit = 0.02 * to_light;
  const Projected p = project(camera, lit);
  const int x = static_cast<int>(80 + 120 * p.x), y = static_cast<int>(120 * p.y);
  const Srgb before = render(scene, camera, kSize).at(x, y);
  const Vec3 centre = lit + 0.2 * to_light;
  scene.balls.push_back({centre, 0.05}), scene.ball_colours.push_back(kGreen);
  const Srgb after = render(scene, camera, kSize).at(x, y);
  EXPECT_LT(after[0], before[0] - 30);
}

// Two level fibres, one above the other, look the same all along: what differs from pixel to pixel is noise.
TEST(Picture, AFibreInShadeIsSmoothWithTheFewSamplesOfARun) {
  Scene scene = scene_of({{{0, 0.055, -0.03}, 0.002}});
  scene.fibres = {{{{-0.3, 0, 0}, {0.3, 0, 0}}, 0.015}, {{{-0.3, 0, 0.032}, {0.3, 0, 0.032}}, 0.015}};
  const Image image = render(scene, millimetres(), kSize, 4);
  for (int y = 60 - 13; y <= 60 + 13; ++y) {
    double sum = 0, squares = 0;
    for (int x = 10; x < 150; ++x) sum += image.at(x, y)[1], squares += image.at(x, y)[1] * image.at(x, y)[1];
    const double mean = sum / 140;
    EXPECT_LT(std::sqrt(squares / 140 - mean * mean), 4) << "row " << y;
  }
}

TEST(Picture, ACutShowsAFlatFaceAndWhatIsBehindIt) {
  Scene scene = scene_of({{{0, 0, 0}, 0.03}, {{0.05, 0.05, 0}, 0.01}});
  scene.balls.push_back({{-0.05, -0.05, 0}, 0.01});
  scene.ball_colours = {kRed, kGreen, kGreen};
  scene.cuts = {{{0, -1, 0}, 0}};  // away with y < 0
  const Image image = render(scene, millimetres(), kSize);
  EXPECT_TRUE(is_background(image.at(80 - 50, 60)));
  EXPECT_TRUE(is_greenish(image.at(80 + 50, 60)));
  // Flat: the same colour wherever nothing but the face itself is near.
  EXPECT_TRUE(is_reddish(image.at(80, 60)));
  for (int d = -25; d <= 25; d += 5) EXPECT_EQ(image.at(80 + d, 60), image.at(80, 60)) << d;
  // A cut that leaves the front half shows it round: darker where it turns away from the light.
  scene.cuts = {{{0, 1, 0}, 0}};
  const Image front = render(scene, millimetres(), kSize);
  EXPECT_GT(front.at(80 - 12, 60 - 15)[0], front.at(80 + 15, 60 + 20)[0] + 20);
  EXPECT_TRUE(is_background(front.at(80 + 50, 60)));
}

TEST(Picture, AWallIsSeenThroughAndTints) {
  Scene scene = scene_of({{{0, 0, 0}, 0.03}});
  scene.walls = {{{{-0.07, -0.05, -0.05}, {0.07, -0.05, -0.05}, {0.07, -0.05, 0.05}, {-0.07, -0.05, 0.05}}}};
  const Image seen = render(scene, millimetres(), kSize);
  EXPECT_TRUE(is_reddish(seen.at(80, 60)));
  EXPECT_FALSE(is_background(seen.at(80 - 50, 60)));
  EXPECT_TRUE(is_background(seen.at(80 - 75, 60)));
  scene.wall_style = WallStyle::faint;
  const Image faint = render(scene, millimetres(), kSize);
  EXPECT_GT(faint.at(80 - 50, 60)[0], seen.at(80 - 50, 60)[0]);
  scene.wall_style = WallStyle::hidden;
  EXPECT_TRUE(is_background(render(scene, millimetres(), kSize).at(80 - 50, 60)));
}

TEST(Picture, TheSameBitsForEveryNumberOfThreads) {
  Scene scene = scene_of({});
  for (int k = 0; k < 500; ++k)
    scene.balls.push_back({{0.1 * std::sin(k), 0.1 * std::sin(3.7 * k), 0.06 * std::cos(1.3 * k)}, 0.004});
  scene.ball_colours.assign(scene.balls.size(), kRed);
  scene.fibres = {{{{-0.05, -0.06, 0}, {0.05, 0.06, 0.02}}, 0.008}};
  scene.walls = {{{{-0.07, -0.05, -0.05}, {0.07, -0.05, -0.05}, {0.07, -0.05, 0.05}, {-0.07, -0.05, 0.05}}}};
  scene.cuts = {{{0, -1, 0}, 0.02}};
  const int threads = thread_count();
  set_thread_count(1);
  const Image one = render(scene, millimetres(), kSize);
  set_thread_count(3);
  const Image three = render(scene, millimetres(), kSize);
  set_thread_count(threads);
  EXPECT_EQ(one, three);
}

TEST(Picture, ATileWithNothingInItIsTheOnlyOneLeftOut) {
  Camera camera = millimetres();
  camera.forward = unit(Vec3{0.3, 1, -0.2}), camera.right = unit(cross(camera.forward, {0, 0, 1}));
  camera.up = cross(camera.right, camera.forward);
  Scene scene = scene_of({{{0.03, 0, 0.02}, 0.004}, {{-0.06, 0, 0.05}, 0.0005}});
  scene.fibres = {{{{-0.05, -0.06, -0.05}, {0.05, 0.06, 0.02}}, 0.003}};
  scene.walls = {{{{-0.02, -0.05, -0.05}, {0.07, -0.05, -0.05}, {0.07, 0.0, 0.05}, {-0.02, 0.0, 0.05}}}};
  const Image orthographic = render(scene, camera, kSize);
  camera.distance = 1e3;  // as good as orthographic, but for perspective every tile is painted
  const Image perspective = render(scene, camera, kSize);
  for (int y0 = 0; y0 < kSize.height; y0 += 8)
    for (int x0 = 0; x0 < kSize.width; x0 += 8) {
      int seen = 0, expected = 0;
      for (int y = y0; y < y0 + 8; ++y)
        for (int x = x0; x < x0 + 8; ++x)
          seen += !is_background(orthographic.at(x, y)), expected += !is_background(perspective.at(x, y));
      EXPECT_NEAR(seen, expected, 4) << x0 << ' ' << y0;  // the far eye's floats are coarse
    }
}

TEST(ColourMap, BeginsDarkEndsLightAndGrowsLighterEvenly) {
  const auto luminance = [](double x) {
    const Rgb c = to_linear(colour_of(ColourMap::sequential, x));
    return 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b;
  };
  EXPECT_EQ(colour_of(ColourMap::sequential, -1), colour_of(ColourMap::sequential, 0));
  EXPECT_EQ(colour_of(ColourMap::sequential, 2), colour_of(ColourMap::sequential, 1));
  EXPECT_EQ(colour_of(ColourMap::sequential, 0), (Srgb{98, 78, 158}));
  EXPECT_EQ(colour_of(ColourMap::sequential, 1), (Srgb{255, 236, 96}));
  EXPECT_EQ(colour_of(ColourMap::diverging, 0.5), (Srgb{221, 221, 221}));
  for (double x = 0; x < 0.99; x += 0.05) EXPECT_LT(luminance(x), luminance(x + 0.05)) << x;
  EXPECT_EQ(colour_of(ColourMap::sequential, std::nan("")), kNoValue);
}

TEST(Ticks, AreRoundAndInside) {
  EXPECT_EQ(ticks_between(0, 0.3, 7).labels,
            (std::vector<std::string>{"0.00", "0.05", "0.10", "0.15", "0.20", "0.25", "0.30"}));
  EXPECT_EQ(ticks_between(-3, 3, 6).labels, (std::vector<std::string>{"-2", "0", "2"}));
  for (const auto& [min, max] : {std::pair{0.0, 1.0}, {0.37, 0.41}, {-5e-7, 3e-6}, {1e5, 9e5}}) {
    const Ticks ticks = ticks_between(min, max, 6);
    EXPECT_GE(ticks.values.size(), 2u);
    EXPECT_LE(ticks.values.size(), 6u);
    for (const double v : ticks.values) EXPECT_TRUE(v >= min - 1e-9 * max && v <= max * (1 + 1e-9)) << v;
  }
  EXPECT_EQ(ticks_between(3, 0, 6).labels, ticks_between(0, 3, 6).labels);  // an axis that counts downwards
  EXPECT_TRUE(ticks_between(2, 2, 6).values.empty());
  EXPECT_TRUE(ticks_between(std::nan(""), 2, 6).values.empty());
  EXPECT_EQ(prefix_for(3e-6, "N").prefix, "µ");
  EXPECT_EQ(prefix_for(0.3, "m/s").prefix, "");
}

TEST(ScaleBar, IsAsLongAsTheCameraSays) {
  Camera camera = millimetres();
  const ScaleBar scale = scale_bar(camera, 160, 120);
  EXPECT_DOUBLE_EQ(scale.length, 0.02);  // a quarter of 160 mm, rounded down to 1, 2 or 5
  EXPECT_EQ(scale.label, "20 mm");
  const Projected from = project(camera, {0, 0, 0}), to = project(camera, {scale.length, 0, 0});
  EXPECT_NEAR(scale.pixels, 120 * (to.x - from.x), 0.5);
}

// ---- what is written on a picture

constexpr Srgb kGround{120, 130, 140};

Image annotated(const Annotations& a) {
  Image image(400, 300);
  image.fill(0, 0, 400, 300, kGround);
  annotate(image, a);
  return image;
}
Annotations bare() {
  Annotations a;
  a.time = std::nan("");
  return a;
}
size_t ink_in(const Image& image, int x0, int y0, int x1, int y1) {
  size_t dark = 0;
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) dark += std::ranges::all_of(image.at(x, y), [](uint8_t v) { return v < 60; });
  return dark;
}

TEST(Annotations, NothingAskedForIsNothingDrawn) {
  Image plain(400, 300);
  plain.fill(0, 0, 400, 300, kGround);
  EXPECT_EQ(annotated(bare()), plain);
}

TEST(Annotations, TheColourBarGoesFromItsLeastBelowToItsMostAbove) {
  Annotations a = bare();
  a.colours = ColourScale{"speed", "m/s", 0, 0.5, ColourMap::sequential, {}};
  const Image image = annotated(a);
  // The bar's pixels are of the map's colours; those of its least and most colour are at its ends.
  std::set<Srgb> of_bar;
  for (int k = 0; k < 120; ++k) of_bar.insert(colour_of(ColourMap::sequential, 1 - (k + 0.5) / 120));
  int left = 400, right = 0, top = 300, bottom = 0;
  for (int y = 0; y < 300; ++y)
    for (int x = 200; x < 400; ++x) {
      if (!of_bar.contains(image.at(x, y))) continue;
      left = std::min(left, x), right = std::max(right, x), top = std::min(top, y), bottom = std::max(bottom, y);
    }
  EXPECT_NEAR(bottom - top + 1, 0.4 * 300, 4);
  EXPECT_NEAR(right - left + 1, 11, 1);  // as wide as letters are high
  const auto close = [](const Srgb& p, const Srgb& q) {
    return std::abs(p[0] - q[0]) + std::abs(p[1] - q[1]) + std::abs(p[2] - q[2]) < 12;
  };
  EXPECT_TRUE(close(image.at(left + 3, top), colour_of(ColourMap::sequential, 1)));
  EXPECT_TRUE(close(image.at(left + 3, bottom), colour_of(ColourMap::sequential, 0)));
  EXPECT_TRUE(close(image.at(left + 3, (top + bottom) / 2), colour_of(ColourMap::sequential, 0.5)));
  // Ticks and numbers beside both ends, the name above.
  EXPECT_GT(ink_in(image, right + 1, top - 5, 400, top + 6), 10u);
  EXPECT_GT(ink_in(image, right + 1, bottom - 5, 400, bottom + 6), 10u);
  EXPECT_GT(ink_in(image, left, top - 30, 400, top - 6), 20u);
}

TEST(Annotations, KindsHaveASwatchEach) {
  Annotations a = bare();
  a.colours = ColourScale{"kind", "", 0, 1, ColourMap::sequential, {"sand", "glass", "steel"}};
  const Image image = annotated(a);
  int last = 0;
  for (size_t k = 0; k < 4; ++k) {
    int count = 0, lowest = 0;
    for (int y = 0; y < 300; ++y)
      for (int x = 200; x < 400; ++x)
        if (image.at(x, y) == colour_of_category(k)) ++count, lowest = y;
    if (k == 3) {
      EXPECT_EQ(count, 0);
      continue;
    }
    EXPECT_EQ(count, 11 * 11) << k;
    EXPECT_GT(lowest, last) << "in the order of the case";
    EXPECT_GT(ink_in(image, 200, lowest - 11, 400, lowest + 1), 10u) << "its name beside it";
    last = lowest;
  }
}

TEST(Annotations, TheTimeIsAboveLeftAndTheScaleBarBelowLeft) {
  Annotations a = bare();
  a.time = 0.125;
  const Image early = annotated(a);
  EXPECT_GT(ink_in(early, 0, 0, 120, 40), 30u);
  EXPECT_EQ(ink_in(early, 0, 60, 400, 300), 0u);
  a.time = 0.25;
  EXPECT_NE(annotated(a), early);
  a = bare();
  a.scale = ScaleBar{0.01, 77, "10 mm"};
  const Image scaled = annotated(a);
  int longest = 0;  // run of ink in a row
  for (int y = 200; y < 300; ++y)
    for (int x = 0, run = 0; x < 400; ++x) {
      run = ink_in(scaled, x, y, x + 1, y + 1) ? run + 1 : 0;
      longest = std::max(longest, run);
    }
  EXPECT_EQ(longest, 77);
  EXPECT_EQ(ink_in(scaled, 0, 0, 400, 200), 0u);
}

TEST(Cameras, FrameTheRegionAndLookAlongTheirAxes) {
  const CameraSubject subject{{{-1, -2, -3}, {1, 2, 5}}, Vec3{0, 0, 1}, 0.5};
  const std::pair<const char*, Vec3> along[] = {{"front", {0, 1, 0}}, {"side", {1, 0, 0}}, {"top", {0, 0, -1}}};
  for (const auto& [name, forward] : along) {
    CameraRequest request;
    request.name = name;
    const Camera camera = make_camera(request, subject, 16.0 / 9);
    EXPECT_NEAR(norm(camera.forward - forward), 0, 1e-12) << name;
    double most = 0;
    for (const double x : {-1, 1})
      for (const double y : {-2, 2})
        for (const double z : {-3, 5}) {
          const Projected p = project(camera, {x, y, z});
          most = std::max({most, std::abs(p.x) / (16.0 / 9), std::abs(p.y - 0.5)});
        }
    EXPECT_GT(most, 0.45) << name;
    EXPECT_LT(most, 0.5) << name;
  }
}

TEST(Cameras, AnUnknownNameIsRefusedWithTheKnownAndTheNearest) {
  CameraRequest request;
  request.name = "frnt";
  try {
    make_camera(request, {}, 1);
    FAIL();
  } catch (const std::invalid_argument& e) {
    EXPECT_STREQ(e.what(), "unknown camera 'frnt', known: front, side, top, junction, free; did you mean 'front'?");
  }
  request.name = "junction";
  EXPECT_THROW(make_camera(request, {}, 1), std::invalid_argument);
  request.name = "free";
  EXPECT_THROW(make_camera(request, {}, 1), std::invalid_argument);
}

TEST(Quantities, AreReadFromFieldsAndUnknownOnesAreRefused) {
  ParticleState p;
  p.velocity = {3, 4, 0}, p.radius = 0.5, p.kind = 1;
  const ParticleFrame frame = frame_of({&p, 1}, 0);
  EXPECT_EQ(values_of(frame, "speed").at(0), 5);
  EXPECT_EQ(values_of(frame, "velocity_y").at(0), 4);
  EXPECT_EQ(values_of(frame, "kind").at(0), 1);
  EXPECT_EQ(values_of(frame, "diameter").at(0), 1);
  try {
    values_of(frame, "sped");
    FAIL();
  } catch (const std::invalid_argument& e) {
    EXPECT_NE(std::string(e.what()).find("did you mean 'speed'?"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("angular_velocity"), std::string::npos) << e.what();
  }
}

// The six numbers are no vector: their root of squares means nothing.
TEST(Quantities, OfAStressAreItsPressureAndItsComponents) {
  ParticleFrame frame;
  frame.positions = {{0, 0, 0}, {1, 0, 0}}, frame.radii = {0.1f, 0.1f};
  frame.fields = {{"contact_stress", 6, {30, 60, 90, 1, 2, 3, -9, -6, 3, 4, 5, 6}}};
  EXPECT_EQ(values_of(frame, "pressure"), (std::vector<double>{60, -4}));
  EXPECT_EQ(values_of(frame, "contact_stress"), values_of(frame, "pressure"));
  EXPECT_EQ(values_of(frame, "contact_stress_xx"), (std::vector<double>{30, -9}));
  EXPECT_EQ(values_of(frame, "contact_stress_zz"), (std::vector<double>{90, 3}));
  EXPECT_EQ(values_of(frame, "contact_stress_xy"), (std::vector<double>{1, 4}));
  EXPECT_EQ(values_of(frame, "contact_stress_yz"), (std::vector<double>{2, 5}));
  EXPECT_EQ(values_of(frame, "contact_stress_xz"), (std::vector<double>{3, 6}));
  for (const char* name : {"pressure", "contact_stress", "contact_stress_xy"})
    EXPECT_EQ(colour_scale({}, name, {1, 2}).unit, "Pa") << name;
  EXPECT_EQ(colour_scale({}, "contact_stress", {1, 2}).quantity, "pressure");
}

TEST(Cuts, AreReadAndOthersRefused) {
  const Bounds region{{0, 0, 0}, {2, 4, 6}};
  const CutPlane below = parse_cut("y<0.5", region), middle = parse_cut("z>", region),
                 any = parse_cut("3,0,4,10", region);
  EXPECT_EQ(below.normal.y, -1);
  EXPECT_EQ(below.offset, -0.5);
  EXPECT_EQ(middle.normal.z, 1);
  EXPECT_EQ(middle.offset, 3);
  EXPECT_NEAR(any.normal.x, 0.6, 1e-15);
  EXPECT_NEAR(any.offset, 2, 1e-15);
  for (const char* wrong : {"", "y", "w<1", "y<one", "1,2,3", "0,0,0,1", "y=2", "y<nan"})
    EXPECT_THROW(parse_cut(wrong, region), std::invalid_argument) << wrong;
  for (const char* wrong : {"", "1920", "1920x", "x1080", "19.5x20", "10x10", "99999x99999", "640X360"})
    EXPECT_THROW(parse_size(wrong), std::invalid_argument) << wrong;
  EXPECT_EQ(parse_size("640x360").width, 640);
}

TEST(Letters, AreAsWideAsTheySayAndCrisp) {
  const Font font(20);
  Image image(200, 60);
  image.fill(0, 0, 200, 60, {255, 255, 255});
  const int end = font.draw(image, 10, 40, "12 µm²", {0, 0, 0});
  EXPECT_EQ(end, 10 + font.width("12 µm²"));
  int dark = 0, outside = 0;
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 200; ++x) {
      dark += image.at(x, y)[0] < 60;
      outside += (x < 9 || x > end + 1 || y < 20 || y > 47) && image.at(x, y)[0] < 255;
    }
  EXPECT_GT(dark, 100);
  EXPECT_EQ(outside, 0);
}

}  // namespace
}  // namespace scree
