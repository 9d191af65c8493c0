// Pictures: a bed that fills all of 1920 x 1080, with shadows, light from all round, 8 rays a pixel, and its file.
#include <unistd.h>

#include <filesystem>

#include "bench/measure.h"
#include "bench/scenes.h"
#include "kernels/parallel.h"
#include "runtime/random.h"
#include "runtime/render/colour_map.h"
#include "runtime/render/renderer.h"

namespace scree::bench {
namespace {

// Grains on a shaken grid as wide as the picture: twice as wide as high, and as deep as they go.
Scene bed(size_t grains) {
  const int high = static_cast<int>(std::cbrt(static_cast<double>(grains) / (16.0 / 9))), wide = high * 16 / 9;
  Random random(1, 5);
  Scene scene;
  for (int k = 0; scene.balls.size() < grains; ++k) {
    const Vec3 shaken{random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2)};
    const Vec3 cell{k % wide - 0.5 * wide, double(k / (wide * high)), k / wide % high - 0.5 * high};
    scene.balls.push_back({kDiameter * (cell + shaken), 0.5 * kDiameter});
    scene.ball_colours.push_back(colour_of(ColourMap::sequential, random.uniform(0, 1)));
  }
  return scene;
}

void picture(benchmark::State& state) {
  set_thread_count(static_cast<int>(state.range(1)));
  const Scene scene = bed(static_cast<size_t>(state.range(0)));
  Camera camera;
  camera.target = {0, 0, 0};
  camera.height = 0.9 * kDiameter * std::cbrt(static_cast<double>(state.range(0)) / (16.0 / 9));
  const PictureSize size;
  Image image(size.width, size.height);
  const auto file = std::filesystem::temp_directory_path() / ("scree_bench_" + std::to_string(getpid()) + ".png");
  for (auto _ : state) {
    image = render(scene, camera, size);
    write_png(file, image);
  }
  std::filesystem::remove(file);
  set_rate(state, "pixels/s", static_cast<double>(size_t(size.width) * size.height * state.iterations()));
  Hash hash;
  for (const uint8_t byte : image.bytes()) hash.add(uint64_t{byte});
  state.SetLabel(hash.text());
}

void register_all() {
  for (const int64_t threads : thread_counts())
    for (const int64_t grains : {30000, 1000000})
      benchmark::RegisterBenchmark("picture", picture)
          ->ArgNames({"grains", "threads"})
          ->Args({grains, threads})
          ->UseRealTime()
          ->Iterations(1)
          ->Unit(benchmark::kMillisecond);
}

[[maybe_unused]] const bool kRegistered = (register_all(), true);

}  // namespace
}  // namespace scree::bench
