#include "fathom/harness/result.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "fathom/core/files.hpp"
#include "fathom/core/hash.hpp"
#include "fathom/core/version.hpp"
#include "fathom/estimators/builtin.hpp"
#include "fathom/harness/manifest.hpp"
#include "fathom/harness/run_folder.hpp"
#include "fathom/measurements/g2o.hpp"
#include "harness/scripted_estimator.hpp"
#include "harness/square_log.hpp"
#include "support/planar.hpp"
#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

using nlohmann::json;
using test::Script;

/// The square as a recording: keyframes every second frame, half a metre further on.
Recording square(bool with_truth = true) {
  Recording recording;
  recording.log = test::square_log();
  for (std::size_t k = 0; k < recording.log.size(); ++k) {
    recording.keyframe_times_ns.push_back(static_cast<std::int64_t>(k) * 1'000'000'000);
    recording.frames.push_back({recording.keyframe_times_ns[k], k, Pose{}});
    recording.frames.push_back(
        {recording.keyframe_times_ns[k] + 500'000'000, k, Pose{0.5, 0.0, 0.1}});
    recording.frame_dead_reckoning.resize(recording.frames.size());
  }
  if (with_truth) recording.ground_truth = test::square_truth();
  return recording;
}

Result evaluated(const Recording& recording, const std::string& type = "ekf",
                 const EstimatorValues& values = {}) {
  return evaluate(recording, {type, type, values}, builtin_estimators(), {}, {});
}

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

void expect_no_null(const json& value, const std::string& where) {
  EXPECT_FALSE(value.is_null()) << where;
  if (!value.is_structured()) return;
  for (const auto& [key, item] : value.items()) expect_no_null(item, where + "." + key);
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
  ReplayOptions options;
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
  EXPECT_EQ(m.at("chi2"), chi2(recording.log, result.replay.trajectory));
  EXPECT_EQ(m.at("chi2_initial"), chi2(recording.log, recording.log.odometry()));
  for (const auto& [name, value] : result.metrics) EXPECT_EQ(m.at(name), value) << name;
  EXPECT_EQ(m.at("mean_position_error_m"), result.accuracy->mean_position_error_m);
  EXPECT_EQ(m.at("ate_rmse_m"), result.accuracy->ate_rmse_m);
  EXPECT_EQ(m.at("heading_rmse_rad"), result.accuracy->heading_rmse_rad);
  EXPECT_EQ(m.at("anees"), result.consistency->anees);
  EXPECT_EQ(m.at("update_ms.max"), *std::ranges::max_element(result.replay.update_ms));
  EXPECT_EQ(m.at("total_ms"), result.replay.total_ms);
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
  ReplayOptions options;
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

TEST(Manifest, HoldsWhatMadeTheResult) {
  const Recording recording = square();
  const Result result =
      evaluated(recording, "trajectory_iekf", {{"max_iterations", OptionValue::scalar("3")}});
  const json m =
      json::parse(manifest_json("fathom run x", {{"seed", "7"}, {"a.b", "[1, 2]"}},
                                {{"a.png", "00ff"}}, recording, result, builtin_estimators()));
  expect_no_null(m, "manifest");
  EXPECT_EQ(m.at("fathom"), version());
  EXPECT_EQ(m.at("command_line"), "fathom run x");
  EXPECT_EQ(m.at("configuration").at("seed"), "7");
  EXPECT_EQ(m.at("data").at("files"), 1);
  EXPECT_EQ(m.at("data").at("fingerprint"), fingerprint_text({{"a.png", "00ff"}}));
  EXPECT_NE(m.at("data").at("fingerprint"), fingerprint_text({{"a.png", "00fe"}}));
  EXPECT_EQ(m.at("estimator").at("options").at("max_iterations"), "3");
  for (const OptionDescription& option : builtin_estimators().find("trajectory_iekf").options) {
    EXPECT_TRUE(m.at("estimator").at("options").contains(option.key)) << option.key;
  }
  for (const char* key : {"type", "compiler", "flags", "ceres", "eigen", "opencv"}) {
    EXPECT_FALSE(m.at("build").at(key).get<std::string>().empty()) << key;
  }
  EXPECT_FALSE(m.at("machine").at("cpu").get<std::string>().empty());
  EXPECT_EQ(m.at("measurements_fnv1a64"), hash_text(to_g2o(recording.log)));
}

// Of the reference implementation's list of test vectors (Fowler, Noll, Vo).
TEST(Manifest, TheHashIsFnv1a) {
  EXPECT_EQ(hash_text(""), "cbf29ce484222325");
  EXPECT_EQ(hash_text("a"), "af63dc4c8601ec8c");
  EXPECT_EQ(hash_text("foobar"), "85944171f73967e8");
}

TEST(RunFolder, HoldsTheTrajectoriesAndTheLog) {
  const Recording recording = square();
  const Result result = evaluated(recording);
  const test::TemporaryFolder folder;
  write_run(folder.path(), recording, result, "{}\n");
  const auto trajectory = read_tum(folder / "trajectory.tum");
  const auto frames = read_tum(folder / "frames.tum");
  ASSERT_EQ(trajectory.size(), 8u);
  ASSERT_EQ(frames.size(), 16u);
  for (std::size_t k = 0; k < 8; ++k) {
    const Pose& pose = result.replay.trajectory[k];
    EXPECT_EQ(trajectory[k].time_ns, recording.keyframe_times_ns[k]);
    EXPECT_LT(test::distance(trajectory[k].pose, pose), 1e-15);
    EXPECT_LT(test::distance(frames[2 * k].pose, pose), 1e-15);
    EXPECT_LT(test::distance(frames[2 * k + 1].pose, compose(pose, {0.5, 0, 0.1})), 1e-15);
  }
  EXPECT_EQ(read_tum(folder / "ground_truth.tum").size(), 8u);
  EXPECT_EQ(read_tum(folder / "dead_reckoning.tum").size(), 16u);
  EXPECT_EQ(to_g2o(read_g2o(folder / "measurements.g2o")), to_g2o(recording.log));
  EXPECT_EQ(read_file(folder / "metrics.json"), metrics_json(result, recording));
  EXPECT_EQ(read_file(folder / "run.json"), "{}\n");
}

TEST(RunFolder, AGraphWithoutTruthHasNeitherFramesNorTruth) {
  Recording recording = square(false);
  recording.frames.clear();
  recording.frame_dead_reckoning.clear();
  const test::TemporaryFolder folder;
  write_run(folder.path(), recording, evaluated(recording), "{}\n");
  EXPECT_FALSE(std::filesystem::exists(folder / "frames.tum"));
  EXPECT_FALSE(std::filesystem::exists(folder / "ground_truth.tum"));
  EXPECT_EQ(read_tum(folder / "dead_reckoning.tum").size(), 8u);
}

}  // namespace
}  // namespace fathom
