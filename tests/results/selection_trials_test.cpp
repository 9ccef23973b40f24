// Over which trials candidates are compared.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "results/selection_runs.hpp"

namespace fathom {
namespace {

using test::asking;
using test::kAroundTenth;
using test::made_run;
using test::runs_of;
using test::selected;
using test::together;
using test::two_estimators;
using test::with_noise_axis;
using ::testing::Contains;
using ::testing::HasSubstr;

// The graph is better in every trial that both did, and did the hard ones as well.
TEST(SelectionTrials, TheHardTrialsThatOneFailedCountAgainstNobody) {
  std::vector<double> filter = kAroundTenth;
  std::vector<double> graph;
  for (std::size_t i = 0; i < 10; ++i) graph.push_back(kAroundTenth[i] - 0.02);
  for (std::size_t i = 7; i < 10; ++i) graph[i] = 1.0;
  auto runs = runs_of(filter, graph);
  for (std::size_t i = 7; i < 10; ++i) runs[2 * i].outcome = "diverged";
  SelectionQuery query;
  query.objective = "mean_position_error_m";
  query.allowed_failures = 0.3;
  const Selection selection = selected(two_estimators(10), runs, query);
  EXPECT_EQ(selection.chosen, 1u);
  EXPECT_NEAR(selection.lead->difference->mean, -0.02, 1e-12);
  EXPECT_NEAR(selection.estimators[0].objective->mean - selection.estimators[1].objective->mean,
              0.02, 1e-12);
  EXPECT_EQ(selection.trials_left_out, 3u);
  EXPECT_THAT(selection.remarks, Contains(HasSubstr("is compared without 3 trials")));
}

// The graph did one run of the second cell, which the filter failed: then the cell stays, and it
// goes.
TEST(SelectionTrials, WhoSharesNoTrialOfACellIsOutAndNotTheCell) {
  auto runs = together(runs_of(kAroundTenth, kAroundTenth),
                       runs_of(std::vector<double>(10, 5.0), std::vector<double>(10, 0.1), 1));
  for (RunRecord& run : runs) {
    if (run.key.cell == 0) continue;
    const bool is_first = run.key.trial == 0;
    if (is_first == (run.key.estimator == "filter")) run.outcome = "diverged";
  }
  SelectionQuery query = asking({"mean_position_error_m<=20"});
  query.objective = "mean_position_error_m";
  query.allowed_failures = 0.5;
  const Selection selection = selected(with_noise_axis(10), runs, query);
  EXPECT_EQ(selection.chosen, 0u);
  EXPECT_FALSE(selection.lead);
  EXPECT_NEAR(selection.estimators[0].objective->mean, 2.55, 1e-12);
  EXPECT_EQ(selection.estimators[1].shares_nothing_in, 1u);
  EXPECT_THAT(selection.remarks,
              Contains("graph: in noise high it has mean_position_error_m in no trial that the "
                       "others have it in, so it cannot be chosen"));
  EXPECT_THAT(selection.remarks, Contains("graph: in noise high one run is left, which is no "
                                          "evidence: its value itself was compared"));
}

TEST(SelectionTrials, WhoFailedAWholeCellIsPassedOverWithTheReason) {
  auto runs = together(runs_of(kAroundTenth, kAroundTenth), runs_of(kAroundTenth, kAroundTenth, 1));
  for (RunRecord& run : runs) {
    if (run.key.cell == 1 && run.key.estimator == "graph") run.outcome = "diverged";
  }
  SelectionQuery query;
  query.objective = "mean_position_error_m";
  query.allowed_failures = 0.5;
  const Selection selection = selected(with_noise_axis(10), runs, query);
  EXPECT_EQ(selection.chosen, 0u);
  EXPECT_THAT(selection.remarks,
              Contains("graph: in noise high no run that is done has a mean_position_error_m to "
                       "compare, so it cannot be chosen"));
}

// Ten small differences one way and two large ones the other.
TEST(SelectionTrials, ALeadAgainstTheRanksIsNotShown) {
  const std::vector<double> filter(60, 1.0);
  std::vector<double> graph;
  for (std::size_t i = 0; i < 60; ++i) graph.push_back(0.9 + 0.0001 * static_cast<double>(i));
  for (std::size_t i = 50; i < 60; ++i) graph[i] = 3.0 + 0.0001 * static_cast<double>(i);
  SelectionQuery query;
  query.objective = "mean_position_error_m";
  const Selection selection = selected(two_estimators(60), runs_of(filter, graph), query);
  EXPECT_EQ(selection.chosen, 0u);
  EXPECT_LT(selection.lead->difference->interval->high, 0.0);
  EXPECT_LT(*selection.lead->difference->signed_rank.p_value, 0.05);
  EXPECT_FALSE(selection.lead->is_significant);
}

// A repeat is one result where all repeats say the same; an estimator that draws is no repeat.
TEST(SelectionTrials, WhatAnEstimatorDrawsOnOneLogCountsEachTime) {
  std::vector<double> filter(9, 0.1);
  filter.push_back(1.0);
  auto runs = runs_of(filter, std::vector<double>(10, 0.3));
  for (RunRecord& run : runs) run.log_hash = "the same";
  SelectionQuery query;
  query.objective = "mean_position_error_m";
  const Selection selection = selected(two_estimators(10), runs, query);
  EXPECT_EQ(selection.chosen, 0u);
  EXPECT_NEAR(selection.estimators[0].objective->mean, 0.19, 1e-12);
}

// It is stored without a log, and repeats what its trial does.
TEST(SelectionTrials, DeadReckoningOfOneLogHasNoInterval) {
  auto runs = runs_of(kAroundTenth, kAroundTenth);
  for (RunRecord& run : runs) run.log_hash = "the same";
  for (std::size_t trial = 0; trial < 10; ++trial) {
    runs.push_back(made_run(kDeadReckoning, 0, trial, 0.7, 0.0));
    runs.back().log_hash = "";
  }
  SelectionQuery query;
  query.objective = "mean_position_error_m";
  const Selection selection = selected(two_estimators(10), runs, query);
  EXPECT_EQ(selection.baseline->objective->count, 1u);
  EXPECT_FALSE(selection.baseline->objective->interval);
}

// They have it: costs of another processor are another quantity.
TEST(SelectionTrials, CostsOfAnotherProcessorAreNotLost) {
  const test::TemporaryFolder folder;
  const auto runs = runs_of(kAroundTenth, kAroundTenth);
  const auto on = [](const std::string& cpu) { return R"({"machine": {"cpu": ")" + cpu + "\"}}"; };
  ResultStore store = ResultStore::write(folder.path(), two_estimators(10), on("X"));
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (i == 14) store.begin_session(on("Y"));
    store.add(runs[i]);
  }
  store.finish();
  const Selection selection = select_estimator(ResultStore::open(folder.path()), {});
  EXPECT_EQ(selection.estimators[0].objective->count, 7u);
  EXPECT_EQ(selection.trials_left_out, 0u);
}

// Twelve trials of one cell and three of the other: each cell counts the same.
TEST(SelectionTrials, TheLeadIsTheDifferenceOfTheObjectives) {
  std::vector<double> filter(12, 1.0);
  std::vector<double> graph(12, 1.1);
  for (std::size_t i = 0; i < 12; ++i) graph[i] += 0.001 * static_cast<double>(i);
  const auto runs =
      together(runs_of(filter, graph), runs_of({1.0, 1.0, 1.0}, {0.5, 0.51, 0.49}, 1));
  SelectionQuery query;
  query.objective = "mean_position_error_m";
  const Selection selection = selected(with_noise_axis(12), runs, query);
  EXPECT_EQ(selection.chosen, 1u);
  const double difference =
      selection.estimators[1].objective->mean - selection.estimators[0].objective->mean;
  EXPECT_NEAR(selection.lead->difference->mean, difference, 1e-12);
  EXPECT_LT(difference, -0.15);
}

// As memory on a system that does not tell it.
TEST(SelectionTrials, AnObjectiveThatSomeRunsLackIsNotMeasured) {
  auto runs = runs_of(kAroundTenth, kAroundTenth);
  for (RunRecord& run : runs) run.metrics["memory_bytes"] = 1e6 + run.metrics["total_ms"];
  for (std::size_t i = 0; i < 4; ++i) runs[i].metrics.erase("memory_bytes");
  SelectionQuery query;
  query.objective = "memory_bytes";
  const Selection selection = selected(two_estimators(10), runs, query);
  EXPECT_FALSE(selection.chosen);
  EXPECT_THAT(selection.remarks,
              Contains(HasSubstr("filter: memory_bytes was not measured in 2 of 10 runs")));
}

TEST(SelectionTrials, RepeatsOfOneResultHaveNoInterval) {
  auto runs = runs_of(std::vector<double>(8, 0.1), std::vector<double>(8, 0.2));
  for (RunRecord& run : runs) run.log_hash = "the same";
  SelectionQuery query = asking({"mean_position_error_m<=0.15"});
  query.objective = "mean_position_error_m";
  const Selection selection = selected(two_estimators(8), runs, query);
  EXPECT_EQ(selection.chosen, 0u);
  EXPECT_FALSE(selection.estimators[0].judgements[0].value->interval);
  EXPECT_THAT(selection.remarks, Contains(HasSubstr("have the same measurements")));
}

}  // namespace
}  // namespace fathom
