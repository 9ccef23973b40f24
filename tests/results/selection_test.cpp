#include "fathom/results/selection.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "results/selection_runs.hpp"
#include "support/input_error.hpp"

namespace fathom {
namespace {

using test::asking;
using test::kAroundTenth;
using test::kHalf;
using test::runs_of;
using test::selected;
using test::together;
using test::two_estimators;
using test::with_noise_axis;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(SelectEstimator, TheIntervalDecidesNotTheMean) {
  const auto verdict = [](const std::string& requirement) {
    return selected(two_estimators(10), runs_of(kAroundTenth, kHalf), asking({requirement}))
        .estimators[0]
        .judgements[0]
        .verdict;
  };
  EXPECT_EQ(verdict("mean_position_error_m<=0.12"), Verdict::meets);
  EXPECT_EQ(verdict("mean_position_error_m<=0.102"), Verdict::not_shown);
  EXPECT_EQ(verdict("mean_position_error_m<=0.095"), Verdict::fails);
  EXPECT_EQ(verdict("mean_position_error_m>=0.08"), Verdict::meets);
  EXPECT_EQ(verdict("mean_position_error_m>0.098"), Verdict::not_shown);
  EXPECT_EQ(verdict("mean_position_error_m>=0.12"), Verdict::fails);
}

TEST(SelectEstimator, EqualValuesAtTheBoundMeetItUnlessItIsExcluded) {
  const std::vector<double> tenth(10, 0.1);
  const auto verdict = [&](const std::string& requirement) {
    return selected(two_estimators(10), runs_of(tenth, tenth), asking({requirement}))
        .estimators[0]
        .judgements[0]
        .verdict;
  };
  EXPECT_EQ(verdict("mean_position_error_m<=0.1"), Verdict::meets);
  EXPECT_EQ(verdict("mean_position_error_m<0.1"), Verdict::fails);
}

TEST(SelectEstimator, TheObjectiveDecidesAmongThoseThatMeetAll) {
  const auto runs = runs_of(kAroundTenth, kAroundTenth);
  SelectionQuery query = asking({"mean_position_error_m<=0.2"});
  const Selection least = selected(two_estimators(10), runs, query);
  ASSERT_TRUE(least.chosen);
  EXPECT_EQ(least.estimators[*least.chosen].name, "filter");
  // 10 ms and 0, 0.1, … 0.9 ms.
  EXPECT_NEAR(least.estimators[0].objective->mean, 10.45, 1e-12);
  ASSERT_TRUE(least.lead);
  EXPECT_EQ(least.lead->runner_up, 1u);
  EXPECT_NEAR(least.lead->difference->mean, 10.45 - (20.0 - 0.225), 1e-12);
  EXPECT_TRUE(least.lead->is_significant);
  query.maximise = true;
  const Selection greatest = selected(two_estimators(10), runs, query);
  EXPECT_EQ(greatest.estimators[greatest.chosen.value()].name, "graph");
  EXPECT_TRUE(greatest.lead->is_significant);
}

TEST(SelectEstimator, WhatDoesNotMeetIsNoCandidateHoweverGood) {
  const Selection selection = selected(two_estimators(10), runs_of(kHalf, kAroundTenth),
                                       asking({"mean_position_error_m<=0.2"}));
  EXPECT_EQ(selection.chosen, 1u);
  EXPECT_FALSE(selection.estimators[0].meets_all);
  EXPECT_FALSE(selection.lead);
}

TEST(SelectEstimator, ATieIsToldAndGoesToTheFirst) {
  SelectionQuery query;
  query.objective = "mean_position_error_m";
  const Selection selection =
      selected(two_estimators(10), runs_of(kAroundTenth, kAroundTenth), query);
  EXPECT_EQ(selection.chosen, 0u);
  ASSERT_TRUE(selection.lead);
  EXPECT_FALSE(selection.lead->is_significant);
  EXPECT_EQ(selection.lead->difference->mean, 0.0);
}

TEST(SelectEstimator, ALeadWithinTheNoiseIsNotSignificant) {
  std::vector<double> other = kAroundTenth;
  for (std::size_t i = 0; i < other.size(); ++i) other[i] += i % 2 == 0 ? 0.011 : -0.01;
  SelectionQuery query;
  query.objective = "mean_position_error_m";
  const Selection selection = selected(two_estimators(10), runs_of(kAroundTenth, other), query);
  EXPECT_EQ(selection.chosen, 0u);
  EXPECT_FALSE(selection.lead->is_significant);
}

TEST(SelectEstimator, NoneMeetsAndWhichIsNearest) {
  const Selection selection = selected(two_estimators(10), runs_of(kAroundTenth, kHalf),
                                       asking({"total_ms<=30", "mean_position_error_m<=0.05"}));
  EXPECT_FALSE(selection.chosen);
  EXPECT_THAT(selection.met_by_none, ElementsAre(1u));
  EXPECT_EQ(selection.estimators[selection.nearest].name, "filter");
}

TEST(SelectEstimator, EachMetBySomeAllByNone) {
  const Selection selection = selected(two_estimators(10), runs_of(kHalf, kAroundTenth),
                                       asking({"total_ms<=15", "mean_position_error_m<=0.2"}));
  EXPECT_FALSE(selection.chosen);
  EXPECT_THAT(selection.met_by_none, IsEmpty());
  // The graph misses 15 ms by a third, the filter 0.2 m by more than its double.
  EXPECT_EQ(selection.estimators[selection.nearest].name, "graph");
}

TEST(SelectEstimator, TheWorstCellCounts) {
  std::vector<double> above = kAroundTenth;
  for (double& value : above) value += 0.1;
  const auto runs = together(runs_of(kAroundTenth, kHalf, 0), runs_of(above, kAroundTenth, 1));
  const Selection selection =
      selected(with_noise_axis(10), runs, asking({"mean_position_error_m<=0.15"}));
  EXPECT_FALSE(selection.chosen);
  EXPECT_EQ(selection.estimators[0].judgements[0].verdict, Verdict::fails);
  EXPECT_EQ(selection.estimators[0].judgements[0].cell, 1u);
  EXPECT_NEAR(selection.estimators[0].judgements[0].value->mean, 0.2, 1e-12);
  EXPECT_EQ(selection.estimators[1].judgements[0].cell, 0u);
  const Selection at_least =
      selected(with_noise_axis(10), runs, asking({"mean_position_error_m>=0.05"}));
  EXPECT_EQ(at_least.estimators[0].judgements[0].verdict, Verdict::meets);
  EXPECT_EQ(at_least.estimators[0].judgements[0].cell, 0u);
}

TEST(SelectEstimator, WhereRestrictsTheCells) {
  const auto runs = together(runs_of(kAroundTenth, kHalf, 0), runs_of(kHalf, kAroundTenth, 1));
  SelectionQuery query = asking({"mean_position_error_m<=0.15"});
  query.where = {"noise=low"};
  const Selection low = selected(with_noise_axis(10), runs, query);
  EXPECT_THAT(low.cells, ElementsAre(0u));
  EXPECT_EQ(low.estimators[low.chosen.value()].name, "filter");
  query.where = {"dataset.odometry.sigma_x_m = high"};
  const Selection high = selected(with_noise_axis(10), runs, query);
  EXPECT_EQ(high.estimators[high.chosen.value()].name, "graph");
  query.where = {"noise=low", "noise=high"};
  EXPECT_FALSE(selected(with_noise_axis(10), runs, query).chosen);
}

TEST(SelectEstimator, WithoutTheObjectiveNobodyIsChosen) {
  auto runs = runs_of(kAroundTenth, kAroundTenth);
  for (RunRecord& run : runs) {
    if (run.key.trial == 3) run.metrics.erase("total_ms");
  }
  const Selection selection = selected(two_estimators(10), runs, {});
  EXPECT_FALSE(selection.chosen);
  EXPECT_TRUE(selection.estimators[0].meets_all);
}

// Five trials can never show a lead at 0.05: the least p of five differences is 2⁻⁴.
TEST(SelectEstimator, FiveTrialsWithTiesShowNoLead) {
  const std::vector<double> errors(5, 0.1);
  auto runs = runs_of(errors, errors);
  for (RunRecord& run : runs) run.metrics["total_ms"] = run.key.estimator == "filter" ? 10.0 : 20.0;
  const Selection selection = selected(two_estimators(5), runs, {});
  EXPECT_EQ(selection.chosen, 0u);
  EXPECT_EQ(selection.lead->difference->signed_rank.p_value, 0.0625);
  EXPECT_FALSE(selection.lead->is_significant);
}

// σ² = 4 in both cells, 100 trials each: the mean of the two means has σ = √(2 · 4 / 100) / 2.

}  // namespace
}  // namespace fathom
