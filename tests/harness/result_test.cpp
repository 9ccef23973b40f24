#include "fathom/harness/result.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "fathom/estimators/builtin.hpp"
#include "harness/scripted_estimator.hpp"
#include "harness/square_log.hpp"
#include "harness/square_result.hpp"

namespace fathom {
namespace {

using nlohmann::json;
using test::evaluated;
using test::expect_no_null;
using test::Script;
using test::square;

Result scripted_result(const Recording& recording, Script& script) {
  EstimatorRegistry registry;
  registry.add(test::scripted(script));
  JudgeOptions judging;
  judging.metrics.alignment = Alignment::none;
  return evaluate(recording, {"name", "scripted", {}}, registry, judging, {});
}

json metrics(const Result& result, const Recording& recording) {
  return json::parse(metrics_json(result, recording));
}

TEST(Evaluate, JudgesTheTrajectoryItself) {
  const Recording recording = square();
  Script script;  // dead reckoning
  const Result result = scripted_result(recording, script);
  const std::vector<Pose> odometry = recording.log.odometry();
  double sum_m = 0.0;
  for (std::size_t k = 0; k < 8; ++k) {
    const Pose& truth = (*recording.ground_truth)[k];
    sum_m += std::hypot(odometry[k].x - truth.x, odometry[k].y - truth.y);
  }
  ASSERT_TRUE(result.accuracy);
  EXPECT_NEAR(result.accuracy->mean_position_error_m, sum_m / 8.0, 1e-12);
  EXPECT_EQ(result.metric("chi2"), result.metric("chi2_initial"));
  EXPECT_NEAR(result.metric("chi2").value(), chi2(recording.log, odometry), 1e-12);
  EXPECT_EQ(result.metric("loop_closures"), 4.0);
  EXPECT_EQ(result.metric("rejected"), 0.0);
  EXPECT_EQ(result.metric("updates"), 3.0);
  const auto baseline = dead_reckoning_metrics(recording, result.options);
  EXPECT_EQ(baseline.at("mean_position_error_m"), result.accuracy->mean_position_error_m);
}

// A schedule that stands still shows in the frames alone: two of them 3 and 4 m behind keyframe 7,
// by a dead reckoning that has them at it.
TEST(Evaluate, FramesBetweenKeyframesCount) {
  Recording recording = square();
  recording.ground_truth = recording.log.odometry();
  for (std::size_t k = 0; k < 8; ++k) {
    const auto time_ns = static_cast<std::int64_t>(k);
    recording.frames.push_back({time_ns, k, {}});
    recording.frame_ground_truth.push_back({time_ns, (*recording.ground_truth)[k]});
  }
  const Pose last = recording.ground_truth->back();
  recording.frames.push_back({8, 7, {}});
  recording.frames.push_back({9, 7, {}});  // without ground truth
  recording.frames.push_back({10, 7, {}});
  recording.frame_ground_truth.push_back({8, compose(last, {3.0, 0.0, 0.0})});
  recording.frame_ground_truth.push_back({10, compose(last, {0.0, 4.0, 0.0})});
  Script script;  // dead reckoning
  const Result result = scripted_result(recording, script);
  EXPECT_EQ(result.metric("mean_position_error_m"), 0.0);
  EXPECT_NEAR(result.metric("frame_mean_position_error_m").value(), 7.0 / 10.0, 1e-12);
  EXPECT_NEAR(result.metric("frame_max_position_error_m").value(), 4.0, 1e-12);
  EXPECT_NEAR(dead_reckoning_metrics(recording, result.options).at("frame_mean_position_error_m"),
              0.7, 1e-12);
  recording.frame_ground_truth.clear();
  EXPECT_FALSE(scripted_result(recording, script).metric("frame_mean_position_error_m"));
}

// Three steps of 1 m straight on: a heading error of step k moves the end by the way that is left.
TEST(JudgedDeadReckoning, HasTheCovarianceOfItsSteps) {
  const Eigen::Matrix3d step = Eigen::Vector3d(0.01, 0.02, 0.03).asDiagonal();
  Recording recording;
  recording.log = MeasurementLog(Pose{5.0, -2.0, 0.0});
  recording.ground_truth = {{5.0, -2.0, 0.0}};
  for (std::size_t k = 0; k < 3; ++k) {
    recording.log.add_keyframe(RelativePose::from_covariance(k, k + 1, {1.0, 0.0, 0.0}, step));
    recording.ground_truth->push_back({6.0 + static_cast<double>(k), -2.0, 0.0});
  }
  recording.ground_truth->back().x += 0.3;
  const DeadReckoning judged = judged_dead_reckoning(recording, {});
  ASSERT_EQ(judged.covariances.size(), 4U);
  EXPECT_TRUE(judged.covariances.front().isZero(0.0));
  Eigen::Matrix3d expected;
  expected << 3 * 0.01, 0.0, 0.0,                      //
      0.0, 3 * 0.02 + (4 + 1) * 0.03, (2 + 1) * 0.03,  //
      0.0, (2 + 1) * 0.03, 3 * 0.03;
  EXPECT_LT((judged.covariances.back() - expected).norm(), 1e-12);
  // The last of three keyframes is off by 0.3 m along x.
  EXPECT_NEAR(judged.metrics.at("anees"), 0.3 * 0.3 / 0.03 / 3.0 / 3.0, 1e-12);
  EXPECT_EQ(judged.metrics, dead_reckoning_metrics(recording, {}));
}

TEST(Evaluate, AnEstimatorIsBetterThanDeadReckoning) {
  const Recording recording = square();
  for (const EstimatorEntry& entry : builtin_estimators().entries()) {
    const Result result = evaluated(recording, entry.name);
    EXPECT_TRUE(result.is_done()) << entry.name;
    EXPECT_LT(result.metric("chi2"), 0.5 * result.metrics.at("chi2_initial")) << entry.name;
    EXPECT_LT(result.accuracy->mean_position_error_m,
              0.5 * dead_reckoning_metrics(recording, {}).at("mean_position_error_m"))
        << entry.name;
    EXPECT_TRUE(result.consistency) << entry.name;
  }
}

TEST(Evaluate, ABatchFromAGuessStartsThere) {
  const Recording recording = square();
  const std::vector<Pose> start = test::square_truth();
  EvaluationOptions options;
  options.mode = SolveMode::batch;
  options.start = start;
  const Result result =
      evaluate(recording, {"c", "ceres_pose_graph", {}}, builtin_estimators(), {}, options);
  EXPECT_NEAR(result.metrics.at("chi2_initial"), chi2(recording.log, start), 1e-12);
  EXPECT_EQ(result.mode, SolveMode::batch);
  EXPECT_LT(result.metric("chi2"), result.metric("chi2_initial"));
}

TEST(Metrics, HoldWhatTheyShould) {
  const Recording recording = square();
  const Result result = evaluated(recording);
  const json m = metrics(result, recording);
  expect_no_null(m, "metrics");
  EXPECT_EQ(m.at("estimator"), "ekf");
  EXPECT_EQ(m.at("outcome"), "converged");
  EXPECT_EQ(m.at("keyframes"), 8);
  EXPECT_EQ(m.at("loop_closures"), 4);
  EXPECT_EQ(m.at("rejected"), 0);
  EXPECT_EQ(m.at("alignment"), "origin");
  EXPECT_EQ(m.at("chi2"), chi2(recording.log, result.run.trajectory));
  EXPECT_EQ(m.at("chi2_initial"), chi2(recording.log, recording.log.odometry()));
  for (const auto& [name, value] : result.metrics) EXPECT_EQ(m.at(name), value) << name;
  EXPECT_EQ(m.at("mean_position_error_m"), result.accuracy->mean_position_error_m);
  EXPECT_EQ(m.at("ate_rmse_m"), result.accuracy->ate_rmse_m);
  EXPECT_EQ(m.at("heading_rmse_rad"), result.accuracy->heading_rmse_rad);
  EXPECT_EQ(m.at("anees"), result.consistency->anees);
  EXPECT_EQ(m.at("update_ms.max"), *std::ranges::max_element(result.run.costs.update_ms));
  EXPECT_EQ(m.at("total_ms"), result.run.costs.total_ms);
  EXPECT_EQ(m.at("outcome_counts").at("converged"), 3);
}

TEST(Metrics, WithoutGroundTruthAccuracyIsAbsent) {
  const Recording recording = square(false);
  const json m = metrics(evaluated(recording), recording);
  expect_no_null(m, "metrics");
  for (const char* key : {"mean_position_error_m", "ate_rmse_m", "heading_rmse_rad", "anees",
                          "alignment", "dead_reckoning", "memory_bytes"}) {
    EXPECT_FALSE(m.contains(key)) << key;
  }
  for (const char* key : {"chi2", "keyframes", "update_ms.median", "total_ms"}) {
    EXPECT_TRUE(m.contains(key)) << key;
  }
}

TEST(Metrics, AFailureHasNoNumbersThatAreNone) {
  const Recording recording = square();
  Script script;
  script.nan_pose = 3;
  const json m = metrics(scripted_result(recording, script), recording);
  expect_no_null(m, "metrics");
  EXPECT_EQ(m.at("outcome"), "numerical_failure");
  for (const char* key : {"chi2", "chi2_used", "mean_position_error_m", "ate_rmse_m", "anees"}) {
    EXPECT_FALSE(m.contains(key)) << key;
  }
}

TEST(Metrics, ListRejectedLoops) {
  const Recording recording = square();
  Script script;
  script.rejected = {{2, 5}};
  const json m = metrics(scripted_result(recording, script), recording);
  EXPECT_EQ(m.at("loop_closures"), 3);
  EXPECT_EQ(m.at("rejected"), 1);
  EXPECT_EQ(m.at("rejected_loops"), json::parse(R"([{"from": 2, "to": 5, "nis": 2.5}])"));
  EXPECT_EQ(m.at("mean_nis_accepted"), 2.5);
}

TEST(Metrics, TellLostLoopsFromRejectedOnes) {
  const Recording recording = square();
  Script script;
  script.updates.assign(3, {});
  script.rejected = {{2, 5}};
  EvaluationOptions options;
  options.mode = SolveMode::batch;
  script.finish = {Outcome::diverged, 3, {}};
  EstimatorRegistry registry;
  registry.add(test::scripted(script));
  const Result result = evaluate(recording, {"scripted", "scripted", {}}, registry, {}, options);
  const json m = metrics(result, recording);
  EXPECT_EQ(m.at("loop_closures"), 0);
  EXPECT_EQ(m.at("rejected"), 1);
  EXPECT_EQ(m.at("lost"), 3);
  EXPECT_EQ(m.at("rejected_loops").size(), 1u);
  EXPECT_FALSE(m.contains("mean_nis_accepted"));
}

TEST(Metrics, ASingleKeyframeHasNoError) {
  Recording recording;
  recording.keyframe_times_ns = {0};
  recording.ground_truth = std::vector<Pose>{Pose{1, 2, 3}};
  const json m = metrics(evaluated(recording), recording);
  EXPECT_FALSE(m.contains("mean_position_error_m"));
  EXPECT_FALSE(m.contains("dead_reckoning"));
}

TEST(Metrics, WithoutUpdatesThereIsNoTimeOfOne) {
  Recording recording;
  recording.keyframe_times_ns = {0};
  const json m = metrics(evaluated(recording), recording);
  expect_no_null(m, "metrics");
  EXPECT_EQ(m.at("updates"), 0);
  EXPECT_FALSE(m.contains("update_ms.median"));
  EXPECT_EQ(m.at("keyframes"), 1);
  EXPECT_EQ(m.at("chi2"), 0.0);
}

}  // namespace
}  // namespace fathom
