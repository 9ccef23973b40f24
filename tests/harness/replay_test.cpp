#include "fathom/harness/replay.hpp"

#include <chrono>
#include <cmath>
#include <numeric>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/estimators/builtin.hpp"
#include "harness/scripted_estimator.hpp"
#include "harness/scripted_replay.hpp"
#include "harness/square_log.hpp"
#include "support/planar.hpp"

namespace fathom {
namespace {

using test::FakeMeter;
using test::replayed;
using test::Script;
using test::scripted;
using test::square_log;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::Ge;
using ::testing::IsEmpty;

TEST(Replay, GivesTheLogInItsOrder) {
  Script script;
  const auto result = replayed(script);
  EXPECT_THAT(script.calls, ElementsAre("create", "add 1", "add 2", "add 3", "add 4", "close 0-4",
                                        "add 5", "close 1-5 2-5", "add 6", "add 7", "close 3-7"));
  EXPECT_EQ(result.trajectory, square_log().odometry());
  EXPECT_EQ(result.loops.size(), 4u);
}

TEST(Replay, CountsOutcomesAndKeepsTheWorst) {
  Script script;
  script.updates = {
      {Outcome::iteration_limit, 20, {}}, {Outcome::diverged, 3, {}}, {Outcome::converged, 4, {}}};
  const auto result = replayed(script);
  EXPECT_THAT(result.outcome_counts, ElementsAre(1, 1, 1, 0));
  EXPECT_EQ(result.outcome, Outcome::diverged);
  EXPECT_EQ(result.iterations, 27);
}

TEST(Replay, ANaNIsAFailureWhateverTheEstimatorSays) {
  Script script;
  script.nan_pose = 5;
  EXPECT_EQ(replayed(script).outcome, Outcome::numerical_failure);
}

TEST(Replay, CostIsTheTimeOfTheCallsAlone) {
  Script script;
  script.in_every_call = [] { std::this_thread::sleep_for(std::chrono::milliseconds(2)); };
  const auto result = replayed(script);
  ASSERT_EQ(result.costs.update_ms.size(), 3u);
  EXPECT_THAT(result.costs.update_ms, Each(Ge(2.0)));
  const double updates_ms =
      std::accumulate(result.costs.update_ms.begin(), result.costs.update_ms.end(), 0.0);
  EXPECT_GE(result.costs.total_ms, updates_ms + 7 * 2.0);
}

TEST(Replay, WithoutLoopsThereIsNoUpdate) {
  MeasurementLog log;
  log.add_keyframe(RelativePose::from_covariance(0, 1, {1, 0, 0}, test::square_covariance()));
  Script script;
  const auto result = replay(log, scripted(script), {}, {});
  EXPECT_THAT(result.costs.update_ms, IsEmpty());
  EXPECT_THAT(result.outcome_counts, Each(0u));
  EXPECT_EQ(result.outcome, Outcome::converged);
  EXPECT_EQ(result.chi2_used, 0.0);
}

TEST(Replay, OneKeyframeAloneIsALog) {
  Script script;
  const auto result = replay(MeasurementLog({1, 2, 3}), scripted(script), {}, {});
  EXPECT_THAT(result.trajectory, ElementsAre(Pose{1, 2, 3}));
  EXPECT_EQ(result.outcome, Outcome::converged);
}

TEST(Replay, ABatchIsOneUpdate) {
  Script script;
  script.updates.assign(3, {Outcome::iteration_limit, 100, {}});  // nothing is solved there
  script.finish = {Outcome::iteration_limit, 9, {}};
  script.rejected = {{2, 5}};
  const std::vector<Pose> start = test::square_truth();
  ReplayOptions options;
  options.mode = SolveMode::batch;
  options.start = start;
  const auto result = replayed(script, options);
  EXPECT_EQ(script.calls.front(), "create batch");
  EXPECT_EQ(script.calls.back(), "finish from 8");
  EXPECT_EQ(result.costs.update_ms.size(), 1u);
  EXPECT_THAT(result.outcome_counts, ElementsAre(0, 1, 0, 0));
  EXPECT_EQ(result.outcome, Outcome::iteration_limit);
  EXPECT_EQ(result.iterations, 9);
  ASSERT_EQ(result.loops.size(), 4u);
  EXPECT_EQ(result.loops[2].fate, LoopFate::rejected);
}

// A batch without a measurement that it could not take is no solution of the log.
TEST(Replay, ABatchThatCannotTakeItsMeasurementsFails) {
  Script script;
  script.updates = {{Outcome::numerical_failure, 0, {}}};
  ReplayOptions options;
  options.mode = SolveMode::batch;
  EXPECT_EQ(replayed(script, options).outcome, Outcome::numerical_failure);
}

TEST(Replay, CovariancesAreOfAllKeyframesOrAbsent) {
  Script script;
  const auto all = replayed(script);
  ASSERT_TRUE(all.covariances);
  ASSERT_EQ(all.covariances->size(), 8u);
  EXPECT_EQ((*all.covariances)[7], 7.0 * Eigen::Matrix3d::Identity());
  ReplayOptions options;
  options.covariances = false;
  EXPECT_FALSE(replayed(script, options).covariances);
  script.without_covariance = 3;
  EXPECT_FALSE(replayed(script).covariances);
}

TEST(Replay, TellsItsProgress) {
  Script script;
  std::vector<std::size_t> done;
  ReplayOptions options;
  options.progress = [&](std::size_t now, std::size_t of) {
    done.push_back(now);
    EXPECT_EQ(of, 8u);
  };
  replayed(script, options);
  EXPECT_THAT(done, ElementsAre(2, 3, 4, 5, 6, 7, 8));
}

TEST(Replay, MeasuresMemoryFromBirthToTheLastUpdate) {
  Script script;
  FakeMeter meter(script);
  ReplayOptions options;
  EXPECT_FALSE(replayed(script, options).costs.memory_bytes);
  script.calls.clear();
  options.memory = &meter;
  EXPECT_EQ(replayed(script, options).costs.memory_bytes, 4242);
  EXPECT_EQ(script.calls[0], "start");
  EXPECT_EQ(script.calls[1], "create");
  EXPECT_EQ(script.calls.back(), "stop");
}

// eᵀ Ω e through homogeneous matrices.
double naive_chi2(const RelativePose& z, const std::vector<Pose>& poses) {
  const Eigen::Matrix3d E = test::homogeneous(z.motion).inverse() *
                            test::homogeneous(poses[z.from]).inverse() *
                            test::homogeneous(poses[z.to]);
  return test::t2v(E).dot(z.information * test::t2v(E));
}

double naive_cost(const MeasurementLog& log, const std::vector<Pose>& poses,
                  const std::function<double(double)>& loss) {
  double sum = 0.0;
  for (std::size_t k = 1; k < log.size(); ++k) {
    sum += naive_chi2(log.arrival(k).step, poses);
    for (const RelativePose& z : log.arrival(k).registrations) sum += loss(naive_chi2(z, poses));
  }
  return sum;
}

TEST(Replay, TheCostUsedLeavesOutWhatWasRejectedAndAppliesTheLoss) {
  const MeasurementLog log = square_log();
  Script script;
  script.rejected = {{1, 5}, {3, 7}};
  script.loss = [](double chi2) { return std::sqrt(chi2); };
  const auto result = replayed(script);
  const auto& loops = log.arrival(5).registrations;
  const double expected = std::sqrt(naive_chi2(log.arrival(4).registrations[0], log.odometry())) +
                          std::sqrt(naive_chi2(loops[1], log.odometry()));
  EXPECT_GT(expected, 1.0);
  EXPECT_NEAR(result.chi2_used, expected, 1e-9 * expected);  // the steps are met exactly
}

TEST(Replay, TheCostUsedOfARobustSolveIsThatOfTheLoss) {
  const MeasurementLog log = square_log();
  const double a = 0.1;
  const auto huber = [a](double s) { return s <= a * a ? s : 2.0 * a * std::sqrt(s) - a * a; };
  const auto cauchy = [a](double s) { return a * a * std::log1p(s / (a * a)); };
  const auto check = [&](const std::string& name, const std::function<double(double)>& loss) {
    EstimatorValues values{{"loss", OptionValue::scalar(name)}};
    if (name != "none") values["loss_scale"] = OptionValue::scalar("0.1");
    const auto result = replay(log, builtin_estimators().find("ceres_pose_graph"), values, {});
    const double expected = naive_cost(log, result.trajectory, loss);
    EXPECT_NEAR(result.chi2_used, expected, 1e-9 * expected) << name;
    const double plain = chi2(log, result.trajectory);
    EXPECT_NEAR(plain, naive_cost(log, result.trajectory, [](double s) { return s; }),
                1e-9 * plain);
    return plain - result.chi2_used;
  };
  EXPECT_GT(check("huber", huber), 1e-3);
  EXPECT_GT(check("cauchy", cauchy), 1e-3);
  EXPECT_NEAR(check("none", [](double s) { return s; }), 0.0, 1e-9);
}

TEST(Replay, IsWhatTheEstimatorGivesByItself) {
  const MeasurementLog log = square_log();
  for (const EstimatorEntry& entry : builtin_estimators().entries()) {
    const auto result = replay(log, entry, {}, {});
    const auto estimator = entry.create({log.origin(), SolveMode::incremental}, {});
    for (std::size_t k = 1; k < log.size(); ++k) {
      estimator->add_keyframe(log.arrival(k).step);
      if (log.arrival(k).registrations.empty()) continue;
      estimator->update({log.arrival(k).registrations});
    }
    EXPECT_EQ(result.trajectory, poses_of(*estimator)) << entry.name;
    ASSERT_TRUE(result.covariances) << entry.name;
    EXPECT_EQ(result.covariances->back(), *estimator->covariance(7)) << entry.name;
    EXPECT_EQ(result.costs.update_ms.size(), 3u) << entry.name;
  }
}

}  // namespace
}  // namespace fathom
