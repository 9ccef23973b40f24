// The harness, validated: measurements drawn from the very model that the estimators assume, with
// which their errors must have the covariances that they tell.

#include <cmath>
#include <map>

#include <Eigen/Core>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "configuration/configured.hpp"
#include "fathom/estimators/builtin.hpp"
#include "fathom/evaluation/consistency.hpp"
#include "fathom/harness/recording.hpp"
#include "fathom/harness/result.hpp"
#include "harness/honesty.hpp"
#include "support/input_error.hpp"

namespace fathom {
namespace {

using test::configured;
using test::input_error_of;
using ::testing::HasSubstr;

constexpr const char* kSmallLog = R"(dataset:
  type: simulated_log
  mission: {type: sweep, legs: 12, leg_length_m: 8, leg_spacing_m: 1.0}
  separation_frames: 2
  odometry: {sigma_x_m: 0.002, sigma_y_m: 0.002, sigma_theta_rad: 0.001}
  loops: {max_distance_m: 1.4, probability: 0.7, sigma_x_m: 0.004, sigma_y_m: 0.004,
          sigma_theta_rad: 0.002}
)";

Configuration with(const std::string& override) {
  Settings settings = test::settings_of(kSmallLog);
  settings.put(parse_override(override));
  return configure(settings, test::kSingle, builtin_estimators());
}

Recording trial_of(const Recorder& recorder, const Configuration& configuration,
                   std::uint64_t trial) {
  return recorder.record(configuration, configuration.reference, builtin_estimators(), {5, trial});
}

TEST(SimulatedLogRecording, HasTheTruthAndTheTimesOfItsKeyframes) {
  const Configuration configuration = configured(kSmallLog);
  const Recorder recorder(configuration);
  const Recording recording = trial_of(recorder, configuration, 0);
  ASSERT_TRUE(recording.ground_truth);
  ASSERT_EQ(recording.ground_truth->size(), recording.log.size());
  ASSERT_EQ(recording.keyframe_times_ns.size(), recording.log.size());
  // Two frames a second, every second a keyframe.
  EXPECT_EQ(recording.keyframe_times_ns[2], 2'000'000'000);
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
  const Configuration noisy = with("dataset.loops.scale_error=0.1");
  EXPECT_EQ(data_settings(noisy), data_settings(configured(kSmallLog)));
  const Recording recording = trial_of(recorder, noisy, 0);
  const Recording plain = trial_of(recorder, configured(kSmallLog), 0);
  EXPECT_EQ(recording.log.odometry(), plain.log.odometry());
  EXPECT_GT(chi2(recording.log, *plain.ground_truth), 2.0 * chi2(plain.log, *plain.ground_truth));
  const Configuration singular = with("dataset.loops.sigma_x_m=0");
  EXPECT_THAT(input_error_of([&] { trial_of(recorder, singular, 0); }),
              HasSubstr("dataset.loops.sigma_x_m: "));
}

struct Judged {
  std::string name;
  EstimatorValues values;
  SolveMode mode = SolveMode::batch;
};

// Of the estimates, and of the measurements themselves: F at the truth is χ² of three degrees of
// freedom a measurement.
void expect_honest(const Configuration& configuration, const std::vector<Judged>& estimators) {
  constexpr std::uint64_t kTrials = 1000;
  const Recorder recorder(configuration);
  std::vector<test::Honesty> honesty(estimators.size());
  double F = 0.0;
  double dimensions = 0.0;
  for (std::uint64_t trial = 0; trial < kTrials; ++trial) {
    const Recording recording = trial_of(recorder, configuration, trial);
    const MeasurementLog& log = recording.log;
    const std::vector<Pose>& truth = *recording.ground_truth;
    F += shared_chi2(log, truth);
    dimensions += 3.0 * static_cast<double>(log.size() - 1 + log.registration_count());
    for (std::size_t i = 0; i < estimators.size(); ++i) {
      const Judged& judged = estimators[i];
      ReplayOptions options;
      options.mode = judged.mode;
      const auto estimate =
          replay(log, builtin_estimators().find(judged.name), judged.values, options);
      ASSERT_TRUE(estimate.covariances) << judged.name;
      const auto found = consistency(estimate.trajectory, truth, *estimate.covariances);
      ASSERT_TRUE(found) << judged.name;
      honesty[i].add(*found);
    }
  }
  EXPECT_NEAR(F / dimensions, 1.0, 3.0 * std::sqrt(2.0 / dimensions));
  for (std::size_t i = 0; i < estimators.size(); ++i) honesty[i].expect(estimators[i].name);
}

TEST(SimulatedLogRecording, EstimatesAreAsHonestAsTheirModel) {
  expect_honest(configured(kSmallLog), {{"sparse_gauss_newton", {}}, {"ceres_pose_graph", {}}});
}

// A picture's error is 2.5 times that of a registration, and estimators are told of both.
TEST(SimulatedLogRecording, EstimatesThatKnowWhatPicturesShareAreAsHonest) {
  Settings settings = test::settings_of(kSmallLog);
  settings.put(parse_override("dataset.mission.legs=5"));
  settings.put(parse_override("dataset.loops.shared_sigma_m=0.01"));
  settings.put(parse_override("dataset.loops.shared_is_told=true"));
  const Configuration told = configure(settings, test::kSingle, builtin_estimators());
  expect_honest(
      told, {{"sparse_gauss_newton", {}},
             {"ceres_pose_graph", {}},
             {"incremental_smoother", {}, SolveMode::incremental},
             {"ekf", {}, SolveMode::incremental},
             {"ekf", {{"shared_errors", OptionValue::scalar("consider")}}, SolveMode::incremental},
             {"trajectory_iekf",
              {{"shared_errors", OptionValue::scalar("states")}},
              SolveMode::incremental}});
}

// Means over trials of what the registrations say of themselves.
std::map<std::string, double> honesty_of(const std::vector<std::string>& overrides) {
  constexpr std::uint64_t kTrials = 40;
  Settings settings = test::settings_of(kSmallLog);
  for (const std::string& text : overrides) settings.put(parse_override(text));
  const Configuration configuration = configure(settings, test::kSingle, builtin_estimators());
  const Recorder recorder(configuration);
  std::map<std::string, double> means;
  for (std::uint64_t trial = 0; trial < kTrials; ++trial) {
    const Recording recording = trial_of(recorder, configuration, trial);
    const Result result = evaluate(recording, {"sparse_gauss_newton", "sparse_gauss_newton", {}},
                                   builtin_estimators(), {}, {});
    for (const char* name : {"mean_nis_truth", "picture_error_correlation", "chi2_per_dof", "anees",
                             "anchored_anees", "relative_anees_1_keyframes"}) {
      means[name] += result.metric(name).value() / kTrials;
    }
  }
  return means;
}

// 40 trials of some 200 registrations each.
TEST(SimulatedLogHonesty, OfTheModelItself) {
  const auto honest = honesty_of({});
  EXPECT_NEAR(honest.at("mean_nis_truth"), 3.0, 0.1);
  EXPECT_NEAR(honest.at("picture_error_correlation"), 0.0, 0.01);
  EXPECT_NEAR(honest.at("chi2_per_dof"), 1.0, 0.03);
  EXPECT_NEAR(honest.at("anchored_anees"), 1.0, 0.15);
  EXPECT_NEAR(honest.at("relative_anees_1_keyframes"), 1.0, 0.15);
}

// The error of the start is in every pose, so that a trial has three that are independent.
TEST(SimulatedLogHonesty, OfAnUncertainStart) {
  const auto honest =
      honesty_of({"dataset.start.x_m=0", "dataset.start.y_m=0", "dataset.start.heading_rad=0",
                  "dataset.start.sigma_m=0.5", "dataset.start.sigma_rad=0.05"});
  EXPECT_NEAR(honest.at("anees"), 1.0, 3.0 * std::sqrt(2.0 / (3.0 * 40.0)));
}

// 200 trials; the keyframes of one share the errors before them.
TEST(SimulatedLogHonesty, DeadReckoningHasTheErrorsThatItsCovarianceTells) {
  const Configuration configuration = configured(kSmallLog);
  const Recorder recorder(configuration);
  std::map<std::string, double> means;
  for (std::uint64_t trial = 0; trial < 200; ++trial) {
    const auto metrics = dead_reckoning_metrics(trial_of(recorder, configuration, trial), {});
    for (const char* name : {"anees", "anchored_anees", "relative_anees_1_keyframes"}) {
      means[name] += metrics.at(name) / 200;
    }
  }
  for (const auto& [name, mean] : means) EXPECT_NEAR(mean, 1.0, 0.15) << name;
}

// A picture's own error s in x and y, as large as the σ of a registration: each has those of its
// two pictures, u has variance 1 + 2 in x and y, and shares 1 of it with its neighbours. Of the sum
// over the three dimensions (1 + 1 + 0) / (3 + 3 + 1). The estimate follows the pictures: F sees
// less of it than the truth does.
TEST(SimulatedLogHonesty, OfErrorsThatAPictureShares) {
  const auto shared = honesty_of({"dataset.loops.shared_sigma_m=0.004"});
  EXPECT_NEAR(shared.at("picture_error_correlation"), 2.0 / 7.0, 0.02);
  EXPECT_NEAR(shared.at("mean_nis_truth"), 7.0, 0.3);
  EXPECT_LT(shared.at("chi2_per_dof"), 0.8 * shared.at("mean_nis_truth") / 3.0);
}

// A compass and holes that loops have not closed: translations known to metres beside registrations
// of millimetres, where a step from the minimum promises nothing but rounding.
TEST(SimulatedLogRecording, EveryBackEndSettlesBesideOpenHoles) {
  const Configuration configuration = configured(R"(dataset:
  type: simulated_log
  mission: {type: sweep, legs: 6, leg_length_m: 20, leg_spacing_m: 1.4}
  odometry: {sigma_x_m: 0.01, sigma_y_m: 0.01, sigma_theta_rad: 0.005}
  loops: {max_distance_m: 2, max_per_keyframe: 2}
  compass: {sigma_rad: 0.0175, interval_s: 2.5}
  holes: {count: 4, length_s: 60}
  start: {x_m: 0, y_m: 0, heading_rad: 0}
)");
  const Recorder recorder(configuration);
  for (std::uint64_t trial = 0; trial < 8; ++trial) {
    const MeasurementLog log = trial_of(recorder, configuration, trial).log;
    for (const EstimatorEntry& entry : builtin_estimators().entries()) {
      const auto estimator = entry.create({log.start()}, {});
      Outcome outcome = Outcome::converged;
      for (std::size_t k = 0; k < log.size(); ++k) {
        const auto& arrival = log.arrival(k);
        if (k > 0) estimator->add_keyframe(arrival.step);
        const Measurements measurements{arrival.registrations, arrival.absolute};
        if (!measurements.is_empty()) {
          outcome = worse(outcome, estimator->update(measurements).outcome);
        }
      }
      EXPECT_TRUE(is_done(outcome)) << entry.name << ", trial " << trial;
    }
  }
}

}  // namespace
}  // namespace fathom
