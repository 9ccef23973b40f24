// Simulated pictures: drawing a floor of 1000 × 1000 pixels, and rendering a view of it at
// 640 × 480, two pixels of the floor to one of the camera. One thread.
#include <benchmark/benchmark.h>
#include <opencv2/core/utility.hpp>

#include "src/datasets/simulated/floor_renderer.hpp"
#include "src/datasets/simulated/sea_floor.hpp"

namespace {

using namespace fathom;

constexpr double kMetresPerPixel = 0.002;
const cv::Size kFloorPx(1000, 1000);

void Floor(benchmark::State& state) {
  cv::setNumThreads(1);
  const auto& [name, kind] = floor_kinds()[static_cast<std::size_t>(state.range(0))];
  state.SetLabel(name);
  for ([[maybe_unused]] auto _ : state)
    benchmark::DoNotOptimize(draw_sea_floor(kFloorPx, kMetresPerPixel, 1, kind));
}
BENCHMARK(Floor)->DenseRange(0, 4)->Unit(benchmark::kMillisecond);

void Rendering(benchmark::State& state) {
  cv::setNumThreads(1);
  CameraModel model;
  model.width = 640;
  model.height = 480;
  model.fx = model.fy = 500.0;
  model.cx = 319.5;
  model.cy = 239.5;
  const Camera camera(model);
  World world;
  world.metres_per_pixel = kMetresPerPixel;
  world.picture = draw_sea_floor(cv::Size(2000, 2000), kMetresPerPixel, 1, FloorKind::mixed);
  const FloorRenderer renderer(camera, ViewRays(camera), world);
  const View view{{0.0, 0.0, 0.3}, 2.0};
  for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(renderer.render(view));
}
BENCHMARK(Rendering)->Unit(benchmark::kMillisecond);

}  // namespace
