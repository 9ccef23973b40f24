// A survey of 10 000 keyframes: what finding candidates takes at its end, and the peak memory of
// the whole front end over it, with a keyframe every frame, dead reckoning, three registrations
// each at most, and pictures of 160 × 120, which are rendered as they are needed. A peak is that of
// the process so far, so take one case at a time:
//
//     long_survey_benchmark --benchmark_filter=LongSurvey/feature_MB:64

#include <cstddef>
#include <cstdint>
#include <span>
#include <sys/resource.h>
#include <vector>

#include <benchmark/benchmark.h>

#include "fathom/front_end/front_end.hpp"
#include "src/datasets/simulated/simulated_survey.hpp"

namespace {

using fathom::CandidateMethod;
using fathom::Pose;

constexpr std::size_t kKeyframes = 10'000;

/// Poses that are known, and, of the motions between them, that each step adds 1 cm.
class Known : public fathom::GivenTrajectory {
 public:
  std::optional<std::vector<fathom::UncertainPose>> motions_to_newest() const override {
    std::vector<fathom::UncertainPose> motions(size() - 1);
    for (std::size_t k = 0; k < motions.size(); ++k) {
      const double steps = static_cast<double>(motions.size() - k);
      motions[k] = {between(pose(k), pose(size() - 1)), 1e-4 * steps * Eigen::Matrix3d::Identity()};
    }
    return motions;
  }
};

// Legs of 100 keyframes, 0.5 m apart.
void Candidates(benchmark::State& state) {
  fathom::CandidateOptions options;
  options.method = static_cast<CandidateMethod>(state.range(0));
  options.max_per_keyframe = 20;
  // Two legs to either side.
  if (options.method != CandidateMethod::overlap) options.max_distance_m = 1.0;
  Known poses;
  for (std::size_t k = 0; k < kKeyframes; ++k) {
    const std::size_t leg = k / 100;
    poses.append({0.5 * static_cast<double>(k % 100), 0.5 * static_cast<double>(leg), 0.1});
  }
  fathom::CandidateSearch search(fathom::Camera(), options);
  const std::vector<fathom::Stance> stances(kKeyframes, 2.0);
  std::size_t left_out = 0;
  for ([[maybe_unused]] auto _ : state) {
    left_out = search.find(poses, stances, kKeyframes - 1).left_out;
  }
  state.counters["left_out"] = static_cast<double>(left_out);
}
BENCHMARK(Candidates)
    ->ArgName("method")
    ->Arg(static_cast<int>(CandidateMethod::distance))
    ->Arg(static_cast<int>(CandidateMethod::mahalanobis))
    ->Arg(static_cast<int>(CandidateMethod::overlap))
    ->Unit(benchmark::kMillisecond);

fathom::SimulatedSurveyOptions long_survey() {
  fathom::SimulatedSurveyOptions options;
  options.world.metres_per_pixel = 0.016;
  options.camera.base.width = 160;
  options.camera.base.height = 120;
  options.camera.base.fx = options.camera.base.fy = 125.0;
  options.mission.legs = 100;
  options.mission.leg_length_m = 25.0;
  options.mission.leg_spacing_m = 1.0;
  options.mission.speed_m_s = 0.5;
  return options;
}

double peak_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

void LongSurvey(benchmark::State& state) {
  const fathom::SimulatedSurvey survey(long_survey(), 1);
  fathom::FrontEndOptions options;
  options.keyframes.separation_frames = 1;
  options.candidates.method = CandidateMethod::overlap;
  options.candidates.min_overlap = 0.3;
  options.candidates.max_per_keyframe = 3;
  options.features.max_features = 300;
  for ([[maybe_unused]] auto _ : state) {
    fathom::PairRegistrar registrar(survey, options.features, options.registration, 1, nullptr,
                                    static_cast<std::size_t>(state.range(0)) << 20);
    fathom::FrontEnd front_end(survey, registrar, options);
    Known poses;
    double at_start = 0.0;
    while (const auto keyframe = front_end.next_keyframe()) {
      if (keyframe->index == kKeyframes) break;
      poses.append(*survey.info(keyframe->frame).ground_truth);
      front_end.register_newest(poses);
      if (keyframe->index == 100) at_start = peak_megabytes();
    }
    state.counters["keyframes"] = static_cast<double>(poses.size());
    state.counters["registrations"] = static_cast<double>(front_end.registrations_tried());
    state.counters["found"] = static_cast<double>(front_end.registrations_found());
    state.counters["features_MB"] = static_cast<double>(registrar.feature_bytes()) / 1048576.0;
    state.counters["peak_MB_at_100"] = at_start;
    state.counters["peak_MB"] = peak_megabytes();
  }
}
BENCHMARK(LongSurvey)
    ->ArgName("feature_MB")
    ->Arg(64)
    ->Arg(static_cast<std::int64_t>(fathom::PairRegistrar::kFeatureBytes >> 20))
    ->Iterations(1)
    ->Unit(benchmark::kSecond)
    ->UseRealTime();

}  // namespace
