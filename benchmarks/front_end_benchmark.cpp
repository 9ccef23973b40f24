// What the front end costs per stage and per frame, on pictures of 640 × 480 of a synthetic floor
// with texture for some 2500 keypoints, of which 2000 are kept: a rich floor. Items per second are
// frames per second.
//
//     front_end_benchmark [--benchmark_filter=...]

#include <array>
#include <cstdint>
#include <vector>

#include <benchmark/benchmark.h>
#include <opencv2/core.hpp>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

#include "fathom/core/random.hpp"
#include "fathom/vision/registration.hpp"

namespace {

using fathom::Camera;
using fathom::FeatureExtractor;
using fathom::FeatureOptions;
using fathom::FloorFeatures;
using fathom::Pose;

constexpr double kAltitudeM = 2.0;

// Noise of equal power at four scales.
cv::Mat floor_picture() {
  cv::RNG random(1);
  cv::Mat sum = cv::Mat::zeros(700, 2000, CV_32F);
  for (const double blur_px : {2.0, 4.0, 8.0, 16.0}) {
    cv::Mat noise(sum.size(), CV_32F);
    random.fill(noise, cv::RNG::NORMAL, 0.0, 1.0);
    cv::GaussianBlur(noise, noise, cv::Size(), blur_px);
    sum += noise * blur_px;
  }
  cv::Mat picture;
  cv::normalize(sum, picture, 0.0, 255.0, cv::NORM_MINMAX, CV_8U);
  return picture;
}

// Frames of a survey that overlap by five sixths, each with sensor noise of its own.
const std::vector<cv::Mat>& frames() {
  static const std::vector<cv::Mat> pictures = [] {
    const cv::Mat floor = floor_picture();
    cv::RNG random(2);
    std::vector<cv::Mat> result;
    for (int x = 0; x + 640 <= floor.cols; x += 100) {
      cv::Mat noise(480, 640, CV_16S);
      random.fill(noise, cv::RNG::NORMAL, 0.0, 3.0);
      cv::Mat seen;
      cv::add(floor(cv::Rect(x, 60 + x / 20, 640, 480)), noise, seen, cv::noArray(), CV_8U);
      result.push_back(seen);
    }
    return result;
  }();
  return pictures;
}

FeatureOptions options_of(const benchmark::State& state) {
  FeatureOptions options;
  options.type = fathom::detectors()[static_cast<std::size_t>(state.range(0))].name;
  return options;
}

FloorFeatures features_of(const FeatureOptions& options, std::size_t frame) {
  return fathom::on_floor(FeatureExtractor(options).extract(frames()[frame % frames().size()]),
                          Camera(), kAltitudeM);
}

void name_detectors(benchmark::internal::Benchmark* benchmark) {
  for (std::size_t i = 0; i < fathom::detectors().size(); ++i) {
    benchmark->Arg(static_cast<std::int64_t>(i));
  }
  benchmark->Unit(benchmark::kMillisecond)->UseRealTime();
}

void label(benchmark::State& state) {
  state.SetLabel(fathom::detectors()[static_cast<std::size_t>(state.range(0))].name);
}

void Extraction(benchmark::State& state) {
  const FeatureExtractor extractor(options_of(state));
  std::size_t frame = 0;
  std::size_t found = 0;
  for ([[maybe_unused]] auto _ : state) {
    found = extractor.extract(frames()[frame++ % frames().size()]).size();
  }
  state.SetItemsProcessed(state.iterations());
  state.counters["features"] = static_cast<double>(found);
  label(state);
}
BENCHMARK(Extraction)->Apply(name_detectors);

// What extraction by SIFT consists of, with 1000 features: all of it; that without flattening; of
// this the detection alone, pyramid and orientations included. What is left describes.
enum SiftPart : std::int64_t { kAll, kUnflattened, kDetection };

void SiftParts(benchmark::State& state) {
  FeatureOptions options;
  options.max_features = 1000;
  options.flatten = state.range(0) == kAll;
  const FeatureExtractor extractor(options);
  const cv::Ptr<cv::Feature2D> finder =
      fathom::find_detector("sift").make(options.detector, options.max_features).finder;
  std::vector<cv::KeyPoint> keypoints;
  std::size_t frame = 0;
  for ([[maybe_unused]] auto _ : state) {
    const cv::Mat& picture = frames()[frame++ % frames().size()];
    if (state.range(0) == kDetection) {
      finder->detect(picture, keypoints);
    } else {
      benchmark::DoNotOptimize(extractor.extract(picture));
    }
  }
  constexpr std::array kLabels{"all", "unflattened", "detection"};
  state.SetLabel(kLabels[static_cast<std::size_t>(state.range(0))]);
}
BENCHMARK(SiftParts)->DenseRange(kAll, kDetection)->Unit(benchmark::kMillisecond)->UseRealTime();

void Matching(benchmark::State& state) {
  const FloorFeatures a = features_of(options_of(state), 0);
  const FloorFeatures b = features_of(options_of(state), 1);
  std::size_t found = 0;
  for ([[maybe_unused]] auto _ : state) found = fathom::match(a.features, b.features, {}).size();
  state.counters["features"] = static_cast<double>(a.size());
  state.counters["matches"] = static_cast<double>(found);
  label(state);
}
BENCHMARK(Matching)->Apply(name_detectors);

// `matches` pairs of which one in `range(1)` is right.
void Ransac(benchmark::State& state) {
  fathom::RandomStream random(3);
  const Pose truth{0.4, -0.1, 0.2};
  std::vector<Eigen::Vector2d> p;
  std::vector<Eigen::Vector2d> q;
  for (int i = 0; i < state.range(0); ++i) {
    q.emplace_back(random.uniform(-1.3, 1.3), random.uniform(-1.0, 1.0));
    p.push_back(transform(truth, q.back()) +
                0.004 * Eigen::Vector2d(random.normal(), random.normal()));
    if (i % state.range(1) != 0) p.back() = {random.uniform(-1.3, 1.3), random.uniform(-1.0, 1.0)};
  }
  std::size_t inliers = 0;
  std::uint64_t seed = 0;
  fathom::RansacOptions options;
  options.max_error_m = 0.03;
  for ([[maybe_unused]] auto _ : state) {
    inliers = fathom::ransac(p, q, options, seed++).inliers.size();
  }
  state.counters["inliers"] = static_cast<double>(inliers);
}
BENCHMARK(Ransac)
    ->ArgNames({"matches", "one_right_in"})
    ->ArgsProduct({{100, 500, 2000}, {1, 5}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

// A frame of visual odometry: features, and registration with the frame before.
void FrameWithRegistration(benchmark::State& state) {
  const FeatureOptions options = options_of(state);
  std::size_t frame = 0;
  FloorFeatures previous = features_of(options, frame++);
  std::int64_t registered = 0;
  for ([[maybe_unused]] auto _ : state) {
    FloorFeatures current = features_of(options, frame++);
    registered += fathom::register_pair(previous, current, {}, frame).found ? 1 : 0;
    previous = std::move(current);
  }
  state.SetItemsProcessed(state.iterations());
  state.counters["registered"] =
      static_cast<double>(registered) / static_cast<double>(state.iterations());
  label(state);
}
BENCHMARK(FrameWithRegistration)->Apply(name_detectors);

}  // namespace
