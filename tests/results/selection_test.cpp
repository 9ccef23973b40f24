#include "fathom/results/selection.hpp"

#include <cmath>
#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/core/random.hpp"
#include "harness/small_study.hpp"
#include "support/input_error.hpp"
#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

using test::input_error_of;
using test::made_run;
using test::TemporaryFolder;
using test::two_estimators;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

SelectionQuery asking(const std::vector<std::string>& requirements) {
  SelectionQuery query;
  for (const std::string& text : requirements) {
    query.requirements.push_back(parse_requirement(text));
  }
  return query;
}

Selection selected(const StudyDescription& study, const std::vector<RunRecord>& runs,
                   const SelectionQuery& query) {
  const TemporaryFolder folder;
  test::write_store(folder.path(), study, runs);
  return select_estimator(ResultStore::open(folder.path()), query);
}

// Errors of a cell's trials by estimator; the filter takes 10 ms and a bit, the graph 20 ms.
std::vector<RunRecord> runs_of(const std::vector<double>& filter_m,
                               const std::vector<double>& graph_m, std::size_t cell = 0) {
  std::vector<RunRecord> runs;
  for (std::size_t trial = 0; trial < filter_m.size(); ++trial) {
    const double jitter_ms = 0.1 * static_cast<double>(trial);
    runs.push_back(made_run("filter", cell, trial, filter_m[trial], 10.0 + jitter_ms));
    runs.push_back(made_run("graph", cell, trial, graph_m[trial], 20.0 - 0.5 * jitter_ms));
  }
  return runs;
}

// Mean 0.10, largest deviation 0.02: the mean's interval is about 0.10 ± 0.008.
const std::vector<double> kAroundTenth{0.08, 0.09, 0.09, 0.10, 0.10, 0.10, 0.11, 0.11, 0.12, 0.10};
const std::vector<double> kHalf(10, 0.5);

StudyDescription with_noise_axis(std::size_t trials) {
  StudyDescription study = two_estimators(trials);
  study.axes = {{"noise", "dataset.odometry.sigma_x_m", {"low", "high"}}};
  return study;
}

std::vector<RunRecord> together(std::vector<RunRecord> a, const std::vector<RunRecord>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

TEST(ParseRequirement, TakesAllFourRelationsWithOrWithoutBlanks) {
  EXPECT_EQ(parse_requirement("total_ms<=20").text(), "total_ms <= 20");
  EXPECT_EQ(parse_requirement(" total_ms < 2e1 ").text(), "total_ms < 20");
  EXPECT_EQ(parse_requirement("anees >= 0.5").text(), "anees >= 0.5");
  EXPECT_EQ(parse_requirement("anees> -1").text(), "anees > -1");
}

TEST(ParseRequirement, TheBoundBelongsToItOrNot) {
  EXPECT_TRUE(parse_requirement("a<=1").holds(1.0));
  EXPECT_FALSE(parse_requirement("a<1").holds(1.0));
  EXPECT_TRUE(parse_requirement("a<1").holds(0.5));
  EXPECT_TRUE(parse_requirement("a>=1").holds(1.0));
  EXPECT_FALSE(parse_requirement("a>1").holds(1.0));
  EXPECT_TRUE(parse_requirement("a>1").holds(1.5));
}

TEST(ParseRequirement, RefusesAnythingElseWithAnExample) {
  for (const char* const text :
       {"", "total_ms", "total_ms=20", "total_ms=<20", "total_ms=>20", "<=20",
        "total_ms<=", "total_ms<=20 ms", "total_ms<=nan", "a<b<1", "total ms<=1", "total_ms<>3"}) {
    EXPECT_THAT(input_error_of([&] { parse_requirement(text); }),
                HasSubstr("for example 'mean_position_error_m <= 0.1'"))
        << text;
  }
}

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

TEST(SelectEstimator, WithoutTheObjectiveNobodyIsChosen) {
  auto runs = runs_of(kAroundTenth, kAroundTenth);
  for (RunRecord& run : runs) {
    if (run.key.trial == 3) run.metrics.erase("total_ms");
  }
  const Selection selection = selected(two_estimators(10), runs, {});
  EXPECT_FALSE(selection.chosen);
  EXPECT_TRUE(selection.estimators[0].meets_all);
}

TEST(SelectEstimator, OneTrialIsComparedByItsValueAndCalledNoEvidence) {
  const Selection selection =
      selected(two_estimators(1), runs_of({0.09}, {0.2}), asking({"mean_position_error_m<=0.1"}));
  EXPECT_EQ(selection.chosen, 0u);
  EXPECT_FALSE(selection.estimators[0].judgements[0].value->interval);
  EXPECT_EQ(selection.estimators[1].judgements[0].verdict, Verdict::fails);
  EXPECT_THAT(selection.remarks, Contains(HasSubstr("one trial is no evidence")));
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

// σ² = 4 in both cells, 100 trials each: the mean of the two means has σ = √(2 · 4 / 100) / 2.
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
