#include "fathom/evaluation/metrics.hpp"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "evaluation/example_run.hpp"

namespace fathom {
namespace {

using test::ExampleRun;
using test::values_of;
using ::testing::Contains;
using ::testing::Key;
using ::testing::Not;

// How good the estimate of the example is.
std::map<std::string, double> errors_and_costs_by_hand() {
  // The step 1-2 is off by (0.3, 0, 0.1) and so is the loop, whose information is one, too.
  const double chi2 = 2.0 * (0.3 * 0.3 + 0.1 * 0.1);
  const double nees = 0.3 * 0.3 / 0.09 + 0.1 * 0.1 / 0.01;
  return {{"mean_position_error_m", 0.1},
          {"ate_rmse_m", 0.3 / std::sqrt(3.0)},
          {"max_position_error_m", 0.3},
          {"final_position_error_m", 0.3},
          {"heading_rmse_rad", 0.1 / std::sqrt(3.0)},
          {"frame_mean_position_error_m", 0.8 / 5.0},
          {"frame_max_position_error_m", 0.5},
          {"rpe_1_keyframes_m", 0.3 / std::sqrt(2.0)},
          {"rpe_1_keyframes_rad", 0.1 / std::sqrt(2.0)},
          {"rpe_2_keyframes_m", 0.3},
          {"rpe_2_keyframes_rad", 0.1},
          {"rpe_1.5_m_m", 0.3},
          {"rpe_1.5_m_rad", 0.1},
          {"anees", 0.5 * nees / 3.0},
          {"position_anees", 0.5 * 1.0 / 2.0},
          {"relative_anees_1_keyframes", 0.5 * (0.09 + 0.01) / 0.01 / 3.0},
          {"relative_anees_1.5_m", (0.09 + 0.01) / 0.02 / 3.0},
          {"anchored_anees", 0.5 * (0.09 + 0.01) / 0.04 / 3.0},
          {"share_inside_2_sigma", 1.0},
          {"chi2", chi2},
          {"chi2_initial", 9.0},
          {"chi2_used", 0.25},
          {"chi2_optimum", 0.125},
          {"chi2_gap", chi2 - 0.125},
          {"chi2_per_dof", chi2 / 3.0},
          {"mean_nis_truth", 0.0},  // the loop is right, and alone
          {"is_local_minimum", 1.0}};
}

// What happened in the run of the example, and what it took.
std::map<std::string, double> counts_and_times_by_hand() {
  return {{"iterations", 7.0},
          {"keyframes", 3.0},
          {"registrations", 1.0},
          {"registrations_tried", 11.0},
          {"registrations_left_out", 2.0},
          {"loop_closures", 3.0},
          {"rejected", 1.0},
          {"lost", 1.0},
          {"loops_kept", 2.0},
          {"mean_nis_accepted", 3.0},
          {"loop_precision", 1.0},
          {"loop_recall", 0.5},
          {"false_loops", 2.0},
          {"false_loops_kept", 1.0},
          {"right_loops_lost", 2.0},
          {"updates", 3.0},
          {"update_ms.median", 3.0},
          {"update_ms.p95", 3.9},
          {"update_ms.max", 4.0},
          {"update_ms.mean", 8.0 / 3.0},
          {"update_ms.total", 8.0},
          {"add_ms.median", 1.0},
          {"add_ms.p95", 1.45},
          {"add_ms.max", 1.5},
          {"add_ms.mean", 1.0},
          {"add_ms.total", 2.0},
          {"newest_covariance_ms.median", 0.5},
          {"newest_covariance_ms.p95", 0.725},
          {"newest_covariance_ms.max", 0.75},
          {"newest_covariance_ms.mean", 0.5},
          {"newest_covariance_ms.total", 1.0},
          {"candidate_covariance_ms", 2.5},
          {"total_with_covariance_ms", 11.0},
          {"total_ms", 10.0},
          {"cpu_ms", 9.5},
          {"memory_bytes", 4096.0}};
}

TEST(Metrics, HandNumbers) {
  const ExampleRun example;
  std::map<std::string, double> expected = errors_and_costs_by_hand();
  expected.merge(counts_and_times_by_hand());
  const auto values = values_of(example.facts());
  for (const auto& [name, value] : expected) {
    ASSERT_THAT(values, Contains(Key(name)));
    EXPECT_NEAR(values.at(name), value, 1e-12) << name;
  }
  // No pair is 5 keyframes apart, and neither a gradient nor a time of covariances is known.
  EXPECT_EQ(values.size(), expected.size());
}

TEST(Metrics, WhatIsNotKnownIsAbsent) {
  ExampleRun example;
  example.run.loops = {{0, 2, LoopFate::used, std::nullopt}};
  example.run.loop_weights = {1.0};
  example.run.costs.memory_bytes.reset();
  example.run.costs.update_ms = {};
  example.run.costs.newest_covariance_ms = {};
  example.run.costs.candidate_covariance_ms.reset();
  RunFacts facts = example.facts();
  facts.is_false_loop = nullptr;
  facts.registrations_tried.reset();
  facts.ground_truth.reset();
  facts.true_overlaps = nullptr;
  facts.chi2_optimum.reset();
  const auto values = values_of(facts);
  for (const char* absent : {"registrations_tried",
                             "mean_position_error_m",
                             "rpe_1_keyframes_m",
                             "anees",
                             "loop_precision",
                             "loop_recall",
                             "chi2_optimum",
                             "chi2_gap",
                             "mean_nis_accepted",
                             "mean_nis_truth",
                             "picture_error_correlation",
                             "false_loops",
                             "right_loops_lost",
                             "memory_bytes",
                             "update_ms.median",
                             "relative_anees_1_keyframes",
                             "anchored_anees",
                             "newest_covariance_ms.median",
                             "total_with_covariance_ms",
                             "candidate_covariance_ms"}) {
    EXPECT_THAT(values, Not(Contains(Key(absent))));
  }
  EXPECT_EQ(values.at("updates"), 0.0);
  EXPECT_EQ(values.at("loops_kept"), 1.0);
}

TEST(Metrics, OfDeadReckoningThereAreNoLoopsAndNoCost) {
  const ExampleRun example;
  RunFacts facts = example.facts();
  facts.run = nullptr;
  const auto values = values_of(facts);
  EXPECT_THAT(values, Contains(Key("mean_position_error_m")));
  EXPECT_THAT(values, Contains(Key("keyframes")));
  for (const Metric& metric : metric_catalogue()) {
    EXPECT_FALSE(metric.is_cost && values.contains(metric.name)) << metric.name;
  }
  EXPECT_THAT(values, Not(Contains(Key("loop_closures"))));
}

TEST(Metrics, ANumberThatIsNotFiniteIsAbsent) {
  ExampleRun example;
  example.estimate[1].x = std::numeric_limits<double>::quiet_NaN();
  const auto values = values_of(example.facts());
  for (const char* absent : {"chi2", "chi2_gap", "mean_position_error_m", "anees"}) {
    EXPECT_FALSE(values.contains(absent)) << absent;
  }
  EXPECT_EQ(values.at("chi2_initial"), 9.0);
}

}  // namespace
}  // namespace fathom
