// Over which trials candidates are compared.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "results/selection_runs.hpp"

namespace fathom {
namespace {

using test::asking;
using test::kAroundTenth;
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
