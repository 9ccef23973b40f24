#include "src/report/ranking.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "report/made_cells.hpp"

namespace fathom::test {
namespace {

using ::testing::DoubleNear;
using ::testing::Optional;

TEST(Ranking, TheBestComesFirstAndWhatIsFurtherIsToldApart) {
  const CellResults cell = cell_of({made("worse", {3.0, 3.1, 2.9, 3.2, 2.8, 3.0}),
                                    made("best", {1.0, 1.2, 0.9, 1.1, 1.0, 1.1}),
                                    made("alike", {1.1, 1.1, 0.8, 1.3, 0.9, 1.15})});
  const auto ranked = ranking(cell, kError);
  ASSERT_TRUE(ranked);
  ASSERT_EQ(ranked->estimators.size(), 3u);
  EXPECT_EQ(ranked->best().name, "best");
  EXPECT_FALSE(ranked->best().difference);
  EXPECT_EQ(ranked->estimators[1].name, "alike");
  EXPECT_FALSE(ranked->find("alike")->is_told_apart());
  EXPECT_TRUE(ranked->find("worse")->is_told_apart());
  EXPECT_NEAR(ranked->find("worse")->difference->mean, 3.0 - 1.05, 1e-12);
  EXPECT_EQ(ranked->told_apart().size(), 1u);
}

// Pairs, not means: a spread that both share does not hide a difference.
TEST(Ranking, DifferencesArePaired) {
  const CellResults cell =
      cell_of({made("a", {1.0, 5.0, 9.0, 2.0, 7.0}), made("b", {1.1, 5.12, 9.09, 2.11, 7.1})});
  const auto ranked = ranking(cell, kError);
  EXPECT_TRUE(ranked->find("b")->is_told_apart());
}

TEST(Ranking, IntervalsHoldTogether) {
  std::vector<EstimatorResults> two{made("a", {1.0, 2.0, 3.0, 4.0, 5.0, 6.0}),
                                    made("b", {1.5, 1.9, 3.3, 4.1, 5.9, 5.8})};
  std::vector<EstimatorResults> six = two;
  for (const char* name : {"c", "d", "e", "f"}) {
    six.push_back(made(name, {2.0, 3.0, 4.1, 5.0, 6.2, 7.0}));
  }
  const auto of_two = ranking(cell_of(two), kError);
  const auto of_six = ranking(cell_of(six), kError);
  EXPECT_DOUBLE_EQ(of_two->level, 0.95);
  EXPECT_DOUBLE_EQ(of_six->level, 0.99);  // five differences
  const Interval narrow = *of_two->find("b")->difference->interval;
  const Interval wide = *of_six->find("b")->difference->interval;
  EXPECT_LT(wide.low, narrow.low);
  EXPECT_GT(wide.high, narrow.high);
  // Exact: the five pairs of c differ one way, so 2 · 2⁻⁶, by Holm at most four times as much.
  EXPECT_THAT(of_six->find("c")->holm_p, Optional(DoubleNear(5.0 * 2.0 / 64.0, 1e-12)));
}

TEST(Ranking, WhatFailedAndDeadReckoningAreNotRanked) {
  EstimatorResults failed = made("failed", {0.1, 0.1});
  failed.runs.back().outcome = "diverged";
  failed.done = 1;
  const CellResults cell =
      cell_of({made(kDeadReckoning, {0.2, 0.2}), failed, made("good", {1.0, 1.0})});
  const auto ranked = ranking(cell, kError);
  ASSERT_TRUE(ranked);
  EXPECT_EQ(ranked->estimators.size(), 1u);
  EXPECT_EQ(ranked->best().name, "good");
  EXPECT_FALSE(ranking(cell_of({failed}), kError));
}

TEST(Ranking, AMetricSaysWhatIsBetter) {
  const auto with = [](const std::string& name, double precision) {
    EstimatorResults one = made(name, {});
    for (std::size_t trial = 0; trial < 3; ++trial) {
      RunRecord run;
      run.key = {0, 0, trial, name};
      run.outcome = "converged";
      run.metrics = {{"loop_precision", precision}, {"anees", precision}};
      one.runs.push_back(run);
    }
    one.done = 3;
    one.metrics["loop_precision"].moments.mean = precision;
    one.metrics["anees"].moments.mean = precision;
    return one;
  };
  const CellResults cell = cell_of({with("few", 0.5), with("all", 1.0)});
  EXPECT_EQ(ranking(cell, "loop_precision")->best().name, "all");
  EXPECT_EQ(ranking(cell, "loop_precision", {"few"})->best().name, "few");
  EXPECT_FALSE(ranking(cell, "anees"));
}

TEST(Ranking, OfEqualsTheFirstIsBestAndNoneIsToldApart) {
  const auto ranked =
      ranking(cell_of({made("a", {1.0, 2.0, 3.0}), made("b", {1.0, 2.0, 3.0})}), kError);
  EXPECT_EQ(ranked->best().name, "a");
  EXPECT_FALSE(ranked->find("b")->is_told_apart());
  EXPECT_EQ(ranked->find("b")->holm_p, std::nullopt);
}

}  // namespace
}  // namespace fathom::test
