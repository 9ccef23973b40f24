// What a selection makes of several surveys: they are what its intervals and tests count.

#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/core/random.hpp"
#include "results/selection_runs.hpp"

namespace fathom {
namespace {

using test::asking;
using test::made_run;
using test::selected;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

StudyDescription surveyed(std::size_t surveys, std::size_t trials) {
  StudyDescription study = test::two_estimators(trials);
  study.surveys = surveys;
  study.configuration = {{"dataset.type", "simulated"}};
  return study;
}

// The graph is better by 1 m on some floors and worse on others, in all trials of each alike.
std::vector<RunRecord> runs_of_floors(const std::vector<double>& advantage_m, std::size_t trials) {
  RandomStream random(2, "survey selection test");
  std::vector<RunRecord> runs;
  for (std::size_t s = 0; s < advantage_m.size(); ++s) {
    for (std::size_t t = 0; t < trials; ++t) {
      const double error_m = 5.0 + 0.01 * random.normal();
      runs.push_back(made_run("filter", 0, t, error_m, 1.0, s));
      runs.push_back(made_run("graph", 0, t, error_m - advantage_m[s], 1.0, s));
    }
  }
  return runs;
}

SelectionQuery least_error() {
  SelectionQuery query;
  query.objective = "mean_position_error_m";
  return query;
}

TEST(SelectOverSurveys, ALeadOnOneFloorIsNoneOverFloors) {
  const std::vector<double> mixed{1.0, -0.9, 0.8, -0.7, 1.0, -0.8, 0.9, -0.9};
  const Selection selection = selected(surveyed(8, 20), runs_of_floors(mixed, 20), least_error());
  ASSERT_TRUE(selection.lead);
  EXPECT_FALSE(selection.lead->is_significant);
  EXPECT_TRUE(selection.lead->difference->is_over_surveys);
  EXPECT_EQ(selection.lead->difference->count, 8u);
  EXPECT_EQ(selection.lead->difference->trials, 160u);
  EXPECT_EQ(selection.repeats, "8 surveys × 20 trials");
  EXPECT_THAT(selection.remarks, Not(Contains(HasSubstr("one survey"))));
}

TEST(SelectOverSurveys, ALeadOnEveryFloorIsOne) {
  const std::vector<double> all(8, 0.3);
  const Selection selection = selected(surveyed(8, 3), runs_of_floors(all, 3), least_error());
  ASSERT_TRUE(selection.lead);
  EXPECT_EQ(selection.chosen, 1u);
  EXPECT_TRUE(selection.lead->is_significant);
}

TEST(SelectOverSurveys, TrialsOfOneSurveySayNothingOfOthers) {
  const Selection selection = selected(surveyed(1, 10), runs_of_floors({0.3}, 10), least_error());
  EXPECT_TRUE(selection.lead->is_significant);
  EXPECT_FALSE(selection.lead->difference->is_over_surveys);
  EXPECT_THAT(selection.remarks, Contains(HasSubstr("one survey: intervals over its trials say")));
}

TEST(SelectOverSurveys, ARequirementIsMetOverFloorsAndNotOverRuns) {
  std::vector<RunRecord> runs;
  for (std::size_t s = 0; s < 6; ++s) {
    for (std::size_t t = 0; t < 50; ++t) {
      const double error_m = (s == 0 ? 0.5 : 0.05) + 1e-4 * static_cast<double>(t);
      for (const char* name : {"filter", "graph"})
        runs.push_back(made_run(name, 0, t, error_m, 1.0, s));
    }
  }
  // The mean of the six floors is 0.13, but with one of them so much worse not known to be.
  const Selection selection =
      selected(surveyed(6, 50), runs, asking({"mean_position_error_m<=0.15"}));
  EXPECT_EQ(selection.estimators[0].judgements[0].verdict, Verdict::not_shown);
  EXPECT_EQ(selection.estimators[0].judgements[0].value->count, 300u);
}

TEST(SelectOverSurveys, NamesTheTrialsThatAreMissing) {
  auto runs = runs_of_floors({0.1, 0.1}, 3);
  runs.pop_back();
  const Selection selection = selected(surveyed(3, 3), runs, least_error());
  EXPECT_THAT(
      selection.remarks,
      Contains("the study is not finished: 11 of 18 runs; missing: filter in all (trials 0, "
               "1, 2 of survey 2); graph in all (trial 2 of survey 1, trials 0, 1, 2 of "
               "survey 2)"));
  EXPECT_EQ(selection.repeats, "2 surveys × 3 trials (5 of 6)");
}

}  // namespace
}  // namespace fathom
