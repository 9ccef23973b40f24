// The second run, without the held-out loops: against least squares by hand, and that the first run
// knows nothing of it.

#include "src/harness/held_out_run.hpp"

#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/estimators/builtin.hpp"
#include "fathom/harness/result.hpp"
#include "harness/by_hand.hpp"
#include "harness/held_out.hpp"
#include "harness/scripted_estimator.hpp"
#include "harness/square_log.hpp"

namespace fathom {
namespace {

using test::ByHand;
using test::Metrics;
using test::metrics_of;
using test::Script;
using ::testing::ElementsAre;

// The square with full covariances, its loops off by some of their standard deviations, one of them
// written from its later end, and headings that pass ±π on the way.
Recording noisy_square() {
  const MeasurementLog exact = test::square_log();
  Recording recording;
  recording.log = MeasurementLog(exact.origin());
  double off = 0.01;
  const auto add = [&](const RelativePose& z) {
    const Pose moved = compose(z.motion, {off, -0.5 * off, 0.8 * off});
    recording.log.add_registration(
        RelativePose::from_covariance(z.from, z.to, moved, 0.3 * test::square_covariance()));
    off = -1.3 * off;
  };
  for (std::size_t k = 1; k < exact.size(); ++k) {
    recording.log.add_keyframe(exact.arrival(k).step);
    for (const RelativePose& z : exact.arrival(k).registrations) {
      add(k == 7 ? z.reversed() : z);
    }
  }
  for (std::size_t k = 0; k < exact.size(); ++k) {
    recording.keyframe_times_ns.push_back(static_cast<std::int64_t>(k));
  }
  recording.is_held_out = {false, true, false, true};  // 1-5 and 7-3
  return recording;
}

Result held_out_result(const Recording& recording, const std::string& name,
                       const EstimatorRegistry& registry = builtin_estimators(),
                       SolveMode mode = SolveMode::incremental) {
  EvaluationOptions options;
  options.mode = mode;
  return evaluate(recording, {name, name, {}}, registry, {}, options);
}

TEST(HeldOutRun, IsLeastSquaresWithoutThem) {
  const Recording recording = noisy_square();
  const auto loops = held_out_loops(recording, MetricOptions())->loops;
  ASSERT_EQ(loops.size(), 2u);
  MeasurementLog rest(recording.log.origin());
  for (std::size_t k = 1; k < recording.log.size(); ++k) {
    rest.add_keyframe(recording.log.arrival(k).step);
    for (const RelativePose& z : recording.log.arrival(k).registrations) {
      if (std::minmax(z.from, z.to) == std::minmax<std::size_t>(1, 5)) continue;
      if (std::minmax(z.from, z.to) == std::minmax<std::size_t>(3, 7)) continue;
      rest.add_registration(z);
    }
  }
  ASSERT_EQ(rest.registration_count(), 2u);
  const ByHand by_hand(rest);
  double position_m = 0.0;
  double heading_rad = 0.0;
  double nis = 0.0;
  for (const RelativePose& z : loops) {
    position_m += 0.5 * by_hand.error(z).head<2>().norm();
    heading_rad += 0.5 * std::abs(by_hand.error(z).z());
    nis += 0.5 * by_hand.nis(z);
  }
  EXPECT_GT(nis, 0.1);
  for (const char* name : {"sparse_gauss_newton", "ceres_pose_graph"}) {
    const Result result = held_out_result(recording, name, builtin_estimators(), SolveMode::batch);
    EXPECT_EQ(result.metric("held_out_loops"), 2.0) << name;
    EXPECT_NEAR(result.metric("held_out_position_error_m").value(), position_m, 1e-6) << name;
    EXPECT_NEAR(result.metric("held_out_heading_error_rad").value(), heading_rad, 1e-6) << name;
    EXPECT_NEAR(result.metric("held_out_nis").value(), nis, 1e-4 * nis) << name;
  }
  // A filter does what it does to another log, to first order the same.
  for (const char* name : {"incremental_smoother", "trajectory_iekf", "ekf"}) {
    EXPECT_NEAR(held_out_result(recording, name).metric("held_out_nis").value(), nis, 0.1 * nis)
        << name;
  }
}

TEST(HeldOutRun, TheFirstRunKnowsNothingOfIt) {
  Recording recording = noisy_square();
  recording.ground_truth = test::square_truth();
  Recording without = recording;
  without.is_held_out.clear();
  for (const EstimatorEntry& entry : builtin_estimators().entries()) {
    if (entry.runs_program) continue;
    const Result one = held_out_result(recording, entry.name);
    const Result other = held_out_result(without, entry.name);
    EXPECT_EQ(metrics_of(one.metrics, false), metrics_of(other.metrics, false)) << entry.name;
    EXPECT_EQ(one.run.trajectory, other.run.trajectory) << entry.name;
    EXPECT_EQ(one.run.covariances, other.run.covariances) << entry.name;
    EXPECT_EQ(one.run.loops.size(), 4u) << entry.name;
    EXPECT_EQ(metrics_of(one.metrics, true).size(), 6u) << entry.name;
    EXPECT_TRUE(metrics_of(other.metrics, true).empty()) << entry.name;
  }
}

// Its steps alone: no loop has a part in it.
TEST(HeldOutRun, DeadReckoningIsHeldAgainstTheSameLoops) {
  const Recording recording = noisy_square();
  MeasurementLog steps(recording.log.origin());
  for (std::size_t k = 1; k < recording.log.size(); ++k) {
    steps.add_keyframe(recording.log.arrival(k).step);
  }
  const ByHand by_hand(steps);
  double nis = 0.0;
  const auto loops = held_out_loops(recording, MetricOptions())->loops;
  for (const RelativePose& z : loops) {
    nis += 0.5 * by_hand.nis(z);
  }
  const Metrics metrics = dead_reckoning_metrics(recording, {});
  EXPECT_EQ(metrics.at("held_out_loops"), 2.0);
  EXPECT_NEAR(metrics.at("held_out_nis"), nis, 1e-4 * nis);
}

// ---- What becomes of it where something fails.

struct ScriptedRuns {
  Script script;
  EstimatorRegistry registry;
  ScriptedRuns() { registry.add(test::scripted(script)); }
  std::ptrdiff_t runs() const { return std::ranges::count(script.calls, "create"); }
};

TEST(HeldOutRun, AFailureLeavesTheFirstRunAsItIs) {
  for (const Outcome outcome : {Outcome::diverged, Outcome::numerical_failure}) {
    ScriptedRuns scripted;
    scripted.script.spoil_report = [&](UpdateReport& report) {
      if (scripted.runs() == 2) report.outcome = outcome;
    };
    const Result result = held_out_result(noisy_square(), "scripted", scripted.registry);
    EXPECT_EQ(scripted.runs(), 2);
    EXPECT_EQ(result.run.outcome, Outcome::converged);
    EXPECT_EQ(result.metric("loop_closures"), 4.0);
    EXPECT_TRUE(metrics_of(result.metrics, true).empty());
  }
}

TEST(HeldOutRun, WhoFailedWithAllLoopsIsNotAskedAgain) {
  ScriptedRuns scripted;
  scripted.script.spoil_report = [](UpdateReport& report) { report.outcome = Outcome::diverged; };
  EXPECT_FALSE(held_out_result(noisy_square(), "scripted", scripted.registry).is_done());
  EXPECT_EQ(scripted.runs(), 1);
}

TEST(HeldOutRun, WithoutACovarianceThereIsNoNis) {
  ScriptedRuns scripted;
  const Result result = held_out_result(noisy_square(), "scripted", scripted.registry);
  EXPECT_TRUE(result.metric("held_out_position_error_m"));
  EXPECT_FALSE(result.metric("held_out_nis"));
}

TEST(HeldOutRun, WithoutALoopThereIsNone) {
  ScriptedRuns scripted;
  Recording recording = noisy_square();
  recording.is_held_out.assign(4, false);
  const Result result = held_out_result(recording, "scripted", scripted.registry);
  EXPECT_EQ(scripted.runs(), 1);
  EXPECT_EQ(metrics_of(result.metrics, true), (Metrics{{"held_out_loops", 0.0}}));
}

// The most that are tested, evenly spaced.
TEST(HeldOutRun, TestsAsManyAsAskedFor) {
  Recording recording = noisy_square();
  recording.is_held_out.assign(4, true);
  MetricOptions metrics;
  metrics.held_out_pairs = 2;
  const HeldOutLoops held_out = held_out_loops(recording, metrics).value();
  EXPECT_EQ(held_out.loops.size(), 4u);
  EXPECT_THAT(tested_pairs(held_out), ElementsAre(KeyframePair{0, 4}, KeyframePair{7, 3}));
}

}  // namespace
}  // namespace fathom
