// What a selection rests on: trials and cells that count, failures, intervals and remarks.

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/core/random.hpp"
#include "results/selection_runs.hpp"
#include "support/input_error.hpp"

namespace fathom {
namespace {

using test::asking;
using test::input_error_of;
using test::kAroundTenth;
using test::kHalf;
using test::made_run;
using test::runs_of;
using test::selected;
using test::together;
using test::two_estimators;
using test::with_noise_axis;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(SelectEstimator, AFailedRunPutsAnEstimatorOutUnlessItsShareIsAllowed) {
  auto runs = runs_of(kAroundTenth, kAroundTenth);
  runs[0].outcome = "diverged";
  runs[0].metrics["mean_position_error_m"] = 1e6;
  SelectionQuery query = asking({"mean_position_error_m<=0.15"});
  const Selection strict = selected(two_estimators(10), runs, query);
  EXPECT_EQ(strict.chosen, 1u);
  EXPECT_EQ(strict.estimators[0].failed, 1u);
  EXPECT_TRUE(strict.estimators[0].has_too_many_failures);
  EXPECT_THAT(strict.remarks, Contains(HasSubstr("filter: 1 of 10 runs failed")));
  query.allowed_failures = 0.1;
  const Selection lenient = selected(two_estimators(10), runs, query);
  EXPECT_EQ(lenient.chosen, 0u);
  // Nine are left, without the 0.08 of the first.
  EXPECT_EQ(lenient.estimators[0].judgements[0].value->count, 9u);
  EXPECT_NEAR(lenient.estimators[0].judgements[0].value->mean, 0.92 / 9.0, 1e-12);
  EXPECT_EQ(lenient.lead->difference->count, 9u);
  EXPECT_THAT(lenient.remarks, Contains(HasSubstr("are left out of its means")));
  query.allowed_failures = 0.09;
  EXPECT_EQ(selected(two_estimators(10), runs, query).chosen, 1u);
}

TEST(SelectEstimator, ANumericalFailureIsAFailureAndAnIterationLimitIsNone) {
  auto runs = runs_of(kAroundTenth, kAroundTenth);
  runs[0].outcome = "iteration_limit";
  runs[1].outcome = "numerical_failure";
  const Selection selection = selected(two_estimators(10), runs, {});
  EXPECT_EQ(selection.estimators[0].failed, 0u);
  EXPECT_EQ(selection.estimators[1].failed, 1u);
}

TEST(SelectEstimator, AMetricThatARunLacksIsNotMeasured) {
  auto runs = runs_of(kAroundTenth, kAroundTenth);
  runs[0].metrics.erase("mean_position_error_m");
  const Selection selection =
      selected(two_estimators(10), runs, asking({"mean_position_error_m<=10"}));
  EXPECT_EQ(selection.estimators[0].judgements[0].verdict, Verdict::not_measured);
  EXPECT_FALSE(selection.estimators[0].judgements[0].value);
  EXPECT_EQ(selection.chosen, 1u);
}

TEST(SelectEstimator, OneTrialIsComparedByItsValueAndCalledNoEvidence) {
  const Selection selection =
      selected(two_estimators(1), runs_of({0.09}, {0.2}), asking({"mean_position_error_m<=0.1"}));
  EXPECT_EQ(selection.chosen, 0u);
  EXPECT_FALSE(selection.estimators[0].judgements[0].value->interval);
  EXPECT_EQ(selection.estimators[1].judgements[0].verdict, Verdict::fails);
  EXPECT_THAT(selection.remarks, Contains(HasSubstr("one trial is no evidence")));
}

TEST(SelectEstimator, AnUnfinishedStudyIsComparedOnTheTrialsThatAllHave) {
  auto runs = runs_of({0.1, 0.1, 0.1}, {0.1, 0.1, 0.1});
  runs.push_back(made_run("filter", 0, 3, 9.0, 99.0));
  const Selection selection = selected(two_estimators(5), runs, {});
  EXPECT_EQ(selection.most_trials, 3u);
  EXPECT_NEAR(selection.estimators[0].objective->mean, 10.1, 1e-12);
  EXPECT_EQ(selection.estimators[0].runs, 4u);
  EXPECT_THAT(selection.remarks,
              Contains("the study is not finished: 7 of 10 runs; missing: filter in all (trial 4); "
                       "graph in all (trials 3, 4)"));
}

TEST(SelectEstimator, CellsWithoutRunsAreLeftOutWithARemark) {
  const Selection selection =
      selected(with_noise_axis(10), runs_of(kAroundTenth, kAroundTenth, 1), {});
  EXPECT_THAT(selection.cells, ElementsAre(1u));
  EXPECT_EQ(selection.cells_asked, 2u);
  EXPECT_THAT(selection.remarks, Contains(HasSubstr("1 of 2 cells have no trial")));
  EXPECT_THAT(input_error_of(
                  [] { selected(two_estimators(2), {made_run("filter", 0, 0, 0.1, 10.0)}, {}); }),
              HasSubstr("no trial has been run by all estimators"));
}

TEST(SelectEstimator, DeadReckoningIsEvidenceAndNeverChosen) {
  auto runs = runs_of(kHalf, kHalf);
  for (std::size_t trial = 0; trial < 10; ++trial) {
    runs.push_back(made_run(kDeadReckoning, 0, trial, 0.01, 0.0));
  }
  const Selection selection =
      selected(two_estimators(10), runs, asking({"mean_position_error_m<=0.1"}));
  EXPECT_FALSE(selection.chosen);
  EXPECT_THAT(selection.met_by_none, ElementsAre(0u));
  ASSERT_TRUE(selection.baseline);
  EXPECT_EQ(selection.baseline->judgements[0].verdict, Verdict::meets);
  EXPECT_FALSE(selection.baseline->objective);
}

TEST(SelectEstimator, CostsOfSeveralJobsAreRemarkedOn) {
  auto runs = runs_of(kAroundTenth, kAroundTenth);
  runs[5].jobs = 2;
  SelectionQuery query;
  EXPECT_THAT(selected(two_estimators(10), runs, query).remarks,
              Contains("measured with 2 jobs at a time: costs are comparable at 1 alone"));
  query.objective = "mean_position_error_m";
  EXPECT_THAT(selected(two_estimators(10), runs, query).remarks, IsEmpty());
}

TEST(SelectEstimator, ErrorsAfterDifferentAlignmentsAreRemarkedOn) {
  StudyDescription study = two_estimators(10);
  study.axes = {{"alignment", "evaluation.alignment", {"as it is", "best fit"}, {"none", "se2"}}};
  const auto runs =
      together(runs_of(kAroundTenth, kAroundTenth, 0), runs_of(kAroundTenth, kAroundTenth, 1));
  SelectionQuery query;
  EXPECT_THAT(selected(study, runs, query).remarks, IsEmpty());
  query.objective = "mean_position_error_m";
  EXPECT_THAT(selected(study, runs, query).remarks,
              ElementsAre(HasSubstr("errors after different alignments (none, se2)")));
  query.where = {"alignment=best fit"};
  EXPECT_THAT(selected(study, runs, query).remarks, IsEmpty());
}

TEST(SelectEstimator, AllowedFailuresAreAShare) {
  const auto runs = runs_of(kAroundTenth, kAroundTenth);
  for (const double bad : {-0.1, 1.1, std::nan("")}) {
    SelectionQuery query;
    query.allowed_failures = bad;
    EXPECT_THAT(input_error_of([&] { selected(two_estimators(10), runs, query); }),
                HasSubstr("expected a share from 0 to 1"));
  }
}

TEST(SelectEstimator, TheIntervalOverCellsIsOfTheTrialsWithinThem) {
  RandomStream random(7, "selection test");
  std::vector<RunRecord> runs;
  double sum_of_squares = 0.0;
  for (std::size_t cell = 0; cell < 2; ++cell) {
    for (std::size_t trial = 0; trial < 100; ++trial) {
      const double noise = 2.0 * random.normal();
      sum_of_squares += noise * noise;
      const double centre = cell == 0 ? 10.0 : 1000.0;
      runs.push_back(made_run("filter", cell, trial, 0.1, centre + noise));
      runs.push_back(made_run("graph", cell, trial, 0.1, 5000.0));
    }
  }
  const Selection selection = selected(with_noise_axis(100), runs, {});
  const TrialMean& objective = selection.estimators[0].objective.value();
  const double sigma = std::sqrt(2.0 * (sum_of_squares / 200.0) / 100.0) / 2.0;
  EXPECT_EQ(objective.count, 200u);
  EXPECT_NEAR(objective.mean, 505.0, 4.0 * sigma);
  // An end of 2000 resamples varies by 2 % of the width.
  const double width = 2.0 * 1.96 * sigma;
  EXPECT_NEAR(objective.interval->high - objective.interval->low, width, 0.1 * width);
  EXPECT_NEAR(0.5 * (objective.interval->high + objective.interval->low), objective.mean,
              0.1 * width);
  const TrialMean& equal = selection.estimators[1].objective.value();
  EXPECT_EQ(equal.interval->low, 5000.0);
  EXPECT_EQ(equal.interval->high, 5000.0);
}

TEST(SelectEstimator, RefusesWhatTheStudyHasNotWithTheNearest) {
  const auto runs = runs_of(kAroundTenth, kAroundTenth);
  const auto refusal = [&](const SelectionQuery& query) {
    return input_error_of([&] { selected(with_noise_axis(10), runs, query); });
  };
  EXPECT_THAT(refusal(asking({"mean_positon_error_m<=1"})),
              HasSubstr("unknown metric 'mean_positon_error_m'; did you mean "
                        "'mean_position_error_m'?"));
  EXPECT_THAT(refusal(asking({"x<=1"})),
              HasSubstr("unknown metric 'x'; there are mean_position_error_m, total_ms"));
  SelectionQuery query;
  query.objective = "total_m";
  EXPECT_THAT(refusal(query), HasSubstr("did you mean 'total_ms'?"));
  query.objective = "total_ms";
  query.where = {"noise=hihg"};
  EXPECT_THAT(refusal(query), HasSubstr("noise is never 'hihg'; did you mean 'high'?"));
  query.where = {"nois=high"};
  EXPECT_THAT(refusal(query), HasSubstr("no axis is called 'nois'; did you mean 'noise'?"));
  query.where = {"noise"};
  EXPECT_THAT(refusal(query), HasSubstr("expected AXIS=LABEL"));
  EXPECT_THAT(input_error_of([&] {
                SelectionQuery swept;
                swept.where = {"noise=high"};
                selected(two_estimators(10), runs, swept);
              }),
              HasSubstr("the study has no sweep"));
}

}  // namespace
}  // namespace fathom
