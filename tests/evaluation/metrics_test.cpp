#include "fathom/evaluation/metrics.hpp"

#include <cmath>
#include <fstream>
#include <limits>
#include <regex>
#include <set>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fathom {
namespace {

using ::testing::Contains;
using ::testing::Key;
using ::testing::Not;

// Three keyframes along x, 1 m apart; the last is estimated 0.3 m too far and 0.1 rad off.
struct Example {
  MeasurementLog log;
  std::vector<Pose> truth{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  std::vector<Pose> estimate{{0, 0, 0}, {1, 0, 0}, {2.3, 0, 0.1}};
  std::vector<Eigen::Matrix3d> covariances{3, Eigen::Vector3d(0.09, 0.01, 0.01).asDiagonal()};
  std::vector<double> update_ms{4.0, 1.0, 3.0};
  std::vector<double> add_ms{0.5, 1.5};
  TrueOverlaps overlaps{{{0, 1, 0.6}, {0, 2, 0.4}, {1, 2, 0.1}}};

  Example() {
    const Eigen::Matrix3d one = Eigen::Matrix3d::Identity();
    log.add_keyframe(RelativePose::from_covariance(0, 1, {1, 0, 0}, one));
    log.add_keyframe(RelativePose::from_covariance(1, 2, {1, 0, 0}, one));
    log.add_registration(RelativePose::from_covariance(0, 2, {2, 0, 0}, one));
  }

  RunFacts facts() const {
    ReplayFacts replay;
    replay.loops = {{0, 2, LoopUse::used, 2.0, 0.9, false},
                    {2, 0, LoopUse::used, 4.0, 0.2, false},
                    {1, 2, LoopUse::used, std::nullopt, 0.8, true},
                    {1, 0, LoopUse::rejected, 50.0, 0.0, true},
                    {0, 1, LoopUse::lost, std::nullopt, 0.0, false}};
    replay.chi2_initial = 9.0;
    replay.chi2_used = 0.25;
    replay.iterations = 7;
    replay.is_local_minimum = true;
    replay.update_ms = update_ms;
    replay.add_ms = add_ms;
    replay.total_ms = 10.0;
    replay.cpu_ms = 9.5;
    replay.memory_bytes = 4096;
    RunFacts facts{.log = log,
                   .registrations_tried = 11,
                   .registrations_left_out = 2,
                   .ground_truth = truth,
                   .true_overlaps = &overlaps,
                   .chi2_optimum = 0.125,
                   .estimate = estimate,
                   .covariances = covariances,
                   .replay = std::move(replay),
                   .options = {}};
    facts.options.rpe_keyframes = {1, 2, 5};
    facts.options.rpe_distances_m = {1.5};
    return facts;
  }
};

std::map<std::string, double> values_of(const RunFacts& facts) {
  return metric_values(judge(facts));
}

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
          {"rpe_1_keyframes_m", 0.3 / std::sqrt(2.0)},
          {"rpe_1_keyframes_rad", 0.1 / std::sqrt(2.0)},
          {"rpe_2_keyframes_m", 0.3},
          {"rpe_2_keyframes_rad", 0.1},
          {"rpe_1.5_m_m", 0.3},
          {"rpe_1.5_m_rad", 0.1},
          {"anees", 0.5 * nees / 3.0},
          {"position_anees", 0.5 * 1.0 / 2.0},
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
          {"total_ms", 10.0},
          {"cpu_ms", 9.5},
          {"memory_bytes", 4096.0}};
}

TEST(Metrics, HandNumbers) {
  const Example example;
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
  const Example example;
  RunFacts facts = example.facts();
  facts.registrations_tried.reset();
  facts.ground_truth.reset();
  facts.true_overlaps = nullptr;
  facts.chi2_optimum.reset();
  facts.replay->loops = {{0, 2, LoopUse::used, std::nullopt, 1.0, std::nullopt}};
  facts.replay->memory_bytes.reset();
  facts.replay->update_ms = {};
  const auto values = values_of(facts);
  for (const char* absent :
       {"registrations_tried", "mean_position_error_m", "rpe_1_keyframes_m", "anees",
        "loop_precision", "loop_recall", "chi2_optimum", "chi2_gap", "mean_nis_accepted",
        "mean_nis_truth", "picture_error_correlation", "false_loops", "right_loops_lost",
        "memory_bytes", "update_ms.median"}) {
    EXPECT_THAT(values, Not(Contains(Key(absent))));
  }
  EXPECT_EQ(values.at("updates"), 0.0);
  EXPECT_EQ(values.at("loops_kept"), 1.0);
}

TEST(Metrics, OfDeadReckoningThereAreNoLoopsAndNoCost) {
  const Example example;
  RunFacts facts = example.facts();
  facts.replay.reset();
  const auto values = values_of(facts);
  EXPECT_THAT(values, Contains(Key("mean_position_error_m")));
  EXPECT_THAT(values, Contains(Key("keyframes")));
  for (const Metric& metric : metric_catalogue()) {
    EXPECT_FALSE(metric.is_cost && values.contains(metric.name)) << metric.name;
  }
  EXPECT_THAT(values, Not(Contains(Key("loop_closures"))));
}

TEST(Metrics, ANumberThatIsNotFiniteIsAbsent) {
  Example example;
  example.estimate[1].x = std::numeric_limits<double>::quiet_NaN();
  const auto values = values_of(example.facts());
  for (const char* absent : {"chi2", "chi2_gap", "mean_position_error_m", "anees"}) {
    EXPECT_FALSE(values.contains(absent)) << absent;
  }
  EXPECT_EQ(values.at("chi2_initial"), 9.0);
}

TEST(MetricCatalogue, NamesAreUniqueAndEndWithTheUnit) {
  std::set<std::string> names;
  for (const Metric& metric : metric_catalogue()) {
    EXPECT_TRUE(names.insert(metric.name).second) << metric.name;
    EXPECT_FALSE(metric.label.empty()) << metric.name;
    EXPECT_FALSE(metric.description.empty()) << metric.name;
    const std::string quantity = metric.name.substr(0, metric.name.find('.'));
    const std::string ending = metric.unit.empty() ? "" : "_" + metric.unit;
    EXPECT_TRUE(quantity.ends_with(ending)) << metric.name;
    EXPECT_EQ(metric.is_cost, metric.unit == "ms" || metric.unit == "bytes") << metric.name;
  }
}

TEST(MetricCatalogue, FindsEveryMetricThatARunHas) {
  const Example example;
  for (const auto& [name, value] : values_of(example.facts())) {
    const auto metric = find_metric(name);
    ASSERT_TRUE(metric) << name;
    EXPECT_EQ(metric->name, name);
    EXPECT_EQ(metric->value(judge(example.facts())), value) << name;
  }
  EXPECT_EQ(find_metric("rpe_10_keyframes_rad")->label_with_unit(), "RPE over 10 keyframes (rad)");
  EXPECT_EQ(find_metric("rpe_1_keyframes_m")->label_with_unit(), "RPE over 1 keyframe (m)");
  EXPECT_EQ(find_metric("rpe_0.5_m_m")->label_with_unit(), "RPE over 0.5 m (m)");
  for (const char* none : {"", "rpe_", "rpe__m_m", "rpe_x_m_m", "rpe_-1_m_m", "update_ms", "f"}) {
    EXPECT_FALSE(find_metric(none)) << none;
  }
  EXPECT_TRUE(is_cost_metric("update_ms.p95"));
  EXPECT_FALSE(is_cost_metric("updates"));
}

// The first column of the table of metrics names nothing else.
TEST(MetricCatalogue, HasWhatTheDocumentationNames) {
  std::ifstream file(std::string(FATHOM_SOURCE_DIR) + "/docs/studies.md");
  std::stringstream text;
  text << file.rdbuf();
  const std::string page = text.str();
  const std::size_t begin = page.find("| metric | meaning |");
  ASSERT_NE(begin, std::string::npos);
  std::set<std::string> names;
  for (const Metric& metric : metric_catalogue()) names.insert(metric.name);
  std::istringstream lines(page.substr(begin, page.find("\n\n", begin) - begin));
  std::size_t found = 0;
  for (std::string line; std::getline(lines, line);) {
    const std::string column = line.substr(0, line.find('|', 1));
    const std::regex quoted("`([^`]+)`");
    for (std::sregex_iterator it(column.begin(), column.end(), quoted), end; it != end; ++it) {
      EXPECT_THAT(names, Contains((*it)[1].str()));
      ++found;
    }
  }
  EXPECT_GT(found, 20U);
}

}  // namespace
}  // namespace fathom
