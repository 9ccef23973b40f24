// The harness, validated: measurements drawn from the very model that the estimators assume, with
// which their errors must have the covariances that they tell.

#include <map>

#include <Eigen/LU>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "configuration/configured.hpp"
#include "fathom/estimators/builtin.hpp"
#include "fathom/evaluation/consistency.hpp"
#include "fathom/harness/recording.hpp"
#include "fathom/harness/result.hpp"
#include "support/input_error.hpp"

namespace fathom {
namespace {

using test::configured;
using test::input_error_of;
using ::testing::HasSubstr;

constexpr const char* kSmallLog = R"(dataset:
  type: simulated_log
  mission: {type: sweep, legs: 4, leg_length_m: 6, leg_spacing_m: 1.0}
  separation_frames: 3
  odometry: {sigma_x_m: 0.002, sigma_y_m: 0.002, sigma_theta_rad: 0.001}
  loops: {max_distance_m: 1.4, probability: 0.7, sigma_x_m: 0.004, sigma_y_m: 0.004,
          sigma_theta_rad: 0.002}
)";

Recording trial_of(const Recorder& recorder, const Configuration& configuration,
                   std::uint64_t trial) {
  return recorder.record(configuration, 0, builtin_estimators(), {5, trial});
}

TEST(SimulatedLogRecording, HasTheTruthAndTheTimesOfItsKeyframes) {
  const Configuration configuration = configured(kSmallLog);
  const Recorder recorder(configuration);
  const Recording recording = trial_of(recorder, configuration, 0);
  ASSERT_TRUE(recording.ground_truth);
  ASSERT_EQ(recording.ground_truth->size(), recording.log.size());
  ASSERT_EQ(recording.keyframe_times_ns.size(), recording.log.size());
  // Two frames a second, every third a keyframe.
  EXPECT_EQ(recording.keyframe_times_ns[2], 3'000'000'000);
  EXPECT_FALSE(recorder.pictures());
  EXPECT_GT(recording.log.registration_count(), recording.log.size());
  const Recording other = trial_of(recorder, configuration, 1);
  EXPECT_EQ(*other.ground_truth, *recording.ground_truth);
  EXPECT_NE(other.log.odometry(), recording.log.odometry());
  EXPECT_EQ(trial_of(recorder, configuration, 1).log.odometry(), other.log.odometry());
}

// Cells that differ in their noise alone share what was opened, and each is drawn with its own.
TEST(SimulatedLogRecording, NoiseIsThatOfTheCell) {
  const Recorder recorder(configured(kSmallLog));
  const Configuration noisy = configured(std::string(kSmallLog) + "dataset.loops.scale_error: 0.1\n");
  EXPECT_EQ(data_settings(noisy), data_settings(configured(kSmallLog)));
  const Recording recording = trial_of(recorder, noisy, 0);
  const Recording plain = trial_of(recorder, configured(kSmallLog), 0);
  EXPECT_EQ(recording.log.odometry(), plain.log.odometry());
  EXPECT_NE(recording.log.edges().back().motion, plain.log.edges().back().motion);
  const Configuration singular =
      configured(std::string(kSmallLog) + "dataset.loops.sigma_x_m: 0\n");
  EXPECT_THAT(input_error_of([&] { trial_of(recorder, singular, 0); }),
              HasSubstr("dataset.loops.sigma_x_m: "));
}

// NEES of each keyframe, and NIS of each registration at the truth, over 1000 trials.
TEST(SimulatedLogRecording, EstimatesAreAsHonestAsTheirModel) {
  constexpr std::uint64_t kTrials = 1000;
  const Configuration configuration = configured(kSmallLog);
  const Recorder recorder(configuration);
  std::map<std::string, std::vector<double>> nees;
  double nis = 0.0;
  std::size_t registrations = 0;
  for (std::uint64_t trial = 0; trial < kTrials; ++trial) {
    const Recording recording = trial_of(recorder, configuration, trial);
    for (const RelativePose& edge : recording.log.edges()) {
      if (edge.to == edge.from + 1) continue;
      nis += chi2(edge, (*recording.ground_truth)[edge.from], (*recording.ground_truth)[edge.to]);
      ++registrations;
    }
    for (const char* name : {"sparse_gauss_newton", "ceres_pose_graph"}) {
      ReplayOptions options;
      options.mode = SolveMode::batch;
      const Replay replayed =
          replay(recording.log, builtin_estimators().find(name), {}, options);
      ASSERT_TRUE(replayed.covariances) << name;
      const auto honesty =
          consistency(replayed.trajectory, *recording.ground_truth, *replayed.covariances);
      ASSERT_TRUE(honesty);
      std::vector<double>& sums = nees[name];
      sums.resize(honesty->pose_nees.size());
      for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += honesty->pose_nees[k];
    }
  }
  EXPECT_NEAR(nis / static_cast<double>(registrations) / 3.0, 1.0, 0.01);
  const Interval interval = anees_interval(kTrials, 3, 0.95);
  for (const auto& [name, sums] : nees) {
    const auto inside = std::ranges::count_if(
        sums, [&](double sum) { return interval.contains(sum / (3.0 * kTrials)); });
    const double share = static_cast<double>(inside) / static_cast<double>(sums.size());
    std::printf("%s: %.3f of %zu\n", name.c_str(), share, sums.size());
    EXPECT_GE(share, 0.93) << name;
    EXPECT_LE(share, 0.97) << name;
  }
}

}  // namespace
}  // namespace fathom
