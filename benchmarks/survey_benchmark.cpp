// Frames per second of the whole front end, other options at their defaults: SIFT, visual odometry
// on every frame, keyframes and their registrations, on a simulated survey at 640 × 480. Pictures
// are rendered beforehand. Items per second are frames per second; those of two threads over those
// of one say how it scales.
//
//     survey_benchmark

#include <cstddef>
#include <cstdint>
#include <vector>

#include <benchmark/benchmark.h>
#include <opencv2/core.hpp>
#include <opencv2/core/utility.hpp>

#include "fathom/front_end/front_end.hpp"
#include "fathom/front_end/visual_odometry.hpp"
#include "src/datasets/simulated/simulated_survey.hpp"

namespace {

using fathom::FrontEndOptions;
using fathom::Pose;

constexpr std::uint64_t kSeed = 1;

// A survey whose pictures are in memory.
class Rendered : public fathom::FrameSource {
 public:
  explicit Rendered(const fathom::SimulatedSurvey& survey) : survey_(survey) {
    for (std::size_t i = 0; i < survey.size(); ++i) pictures_.push_back(survey.image(i));
  }

  const fathom::Camera& camera() const override { return survey_.camera(); }
  std::size_t size() const override { return pictures_.size(); }
  const fathom::FrameInfo& info(std::size_t i) const override { return survey_.info(i); }
  cv::Mat image(std::size_t i) const override { return pictures_[i]; }
  std::uint64_t picture_id(std::size_t i) const override { return survey_.picture_id(i); }
  bool has_odometry() const override { return false; }
  bool has_ground_truth() const override { return true; }

 private:
  const fathom::SimulatedSurvey& survey_;
  std::vector<cv::Mat> pictures_;
};

// The dead reckoning of the keyframes, in place of an estimator, which has its own benchmark.
class DeadReckoning : public fathom::TrajectoryView {
 public:
  void append(const Pose& motion) { poses_.push_back(compose(poses_.back(), motion)); }
  std::size_t size() const override { return poses_.size(); }
  Pose pose(std::size_t k) const override { return poses_[k]; }

 private:
  std::vector<Pose> poses_{Pose{}};
};

// Three legs that overlap sideways.
fathom::SimulatedSurvey sweep() {
  fathom::SimulatedSurveyOptions options;
  options.mission.legs = 3;
  options.mission.leg_length_m = 6.0;
  options.odometry.source = fathom::OdometrySource::kVisualOdometry;
  return fathom::SimulatedSurvey(options, kSeed);
}

void Survey(benchmark::State& state) {
  static const fathom::SimulatedSurvey survey = sweep();
  static const Rendered frames(survey);
  FrontEndOptions options;
  options.keyframes.separation_frames = static_cast<int>(state.range(0));
  options.candidates.max_distance_m = 3.0;
  options.features.max_features = static_cast<int>(state.range(1));
  const int threads_before = cv::getNumThreads();
  cv::setNumThreads(static_cast<int>(state.range(2)));

  std::size_t tried = 0;
  std::size_t found = 0;
  std::size_t failures = 0;
  for ([[maybe_unused]] auto _ : state) {
    fathom::PairRegistrar registrar(frames, options.features, options.registration, kSeed);
    const fathom::VisualOdometry odometry(frames, registrar, options.visual_odometry);
    fathom::FrontEnd front_end(odometry, registrar, options);
    DeadReckoning trajectory;
    while (const auto keyframe = front_end.next_keyframe()) {
      if (!keyframe->step) continue;
      trajectory.append(keyframe->step->motion);
      front_end.register_newest(trajectory);
    }
    tried = front_end.registrations_tried();
    found = front_end.registrations_found();
    failures = odometry.failures();
  }
  cv::setNumThreads(threads_before);
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(frames.size()));
  state.counters["frames"] = static_cast<double>(frames.size());
  state.counters["registrations"] = static_cast<double>(tried);
  state.counters["found"] = static_cast<double>(found);
  state.counters["odometry_failures"] = static_cast<double>(failures);
}
BENCHMARK(Survey)
    ->ArgNames({"separation_frames", "max_features", "threads"})
    ->Args({10, FrontEndOptions().features.max_features, 1})
    ->Args({10, FrontEndOptions().features.max_features, 2})
    ->Args({3, FrontEndOptions().features.max_features, 1})
    ->Args({3, FrontEndOptions().features.max_features, 2})
    ->Args({10, 1000, 1})
    ->Args({10, 1000, 2})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
