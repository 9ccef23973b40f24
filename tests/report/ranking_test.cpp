#include "src/report/ranking.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/core/random.hpp"
#include "report/made_cells.hpp"

namespace fathom::test {
namespace {

using ::testing::DoubleNear;
using ::testing::Optional;

// As many surveys of one trial.
CellResults of_surveys(
    const std::vector<std::pair<std::string, std::vector<double>>>& errors_by_name) {
  std::vector<EstimatorResults> estimators;
  for (const auto& [name, errors] : errors_by_name) estimators.push_back(made(name, errors, true));
  return surveyed(std::move(estimators));
}

std::vector<double> moved(std::vector<double> values, double by, double spread = 0.0) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] += by + spread * static_cast<double>(i % 3);
  }
  return values;
}

const std::vector<double> kEight{1.0, 1.2, 0.9, 1.1, 1.0, 1.1, 1.3, 0.8};

TEST(Ranking, TheBestComesFirstAndEachHasAStanding) {
  const CellResults cell = of_surveys({{"worse", moved(kEight, 2.0, 0.1)},
                                       {"best", kEight},
                                       {"equivalent", moved(kEight, 0.001, 0.001)},
                                       {"unclear", {1.3, 1.0, 0.8, 1.4, 0.9, 1.3, 1.6, 0.7}}});
  const auto ranked = ranking(cell, kError);
  ASSERT_TRUE(ranked);
  ASSERT_EQ(ranked->estimators.size(), 4u);
  EXPECT_TRUE(ranked->gives_verdict());
  EXPECT_EQ(ranked->best().name, "best");
  EXPECT_EQ(ranked->best().standing, Standing::best);
  EXPECT_FALSE(ranked->best().difference);
  EXPECT_EQ(ranked->find("equivalent")->standing, Standing::equivalent);
  EXPECT_EQ(ranked->find("unclear")->standing, Standing::not_shown);
  EXPECT_EQ(ranked->find("worse")->standing, Standing::worse);
  EXPECT_NEAR(ranked->find("worse")->difference->mean, 2.0875, 1e-12);
  EXPECT_NEAR(ranked->margin, 0.01 * 1.05, 1e-12);
}

// Pairs, not means: a spread that both share does not hide a difference.
TEST(Ranking, DifferencesArePaired) {
  const CellResults cell = of_surveys(
      {{"a", {1.0, 5.0, 9.0, 2.0, 7.0, 3.0}}, {"b", {1.1, 5.12, 9.09, 2.11, 7.1, 3.08}}});
  EXPECT_EQ(ranking(cell, kError)->find("b")->standing, Standing::worse);
}

// 0.1 of 4.5 in every survey: p is 2 · 2⁻⁶, and a margin of 10 % is more.
TEST(Ranking, WhatIsSignificantAndSmallIsNotWorse) {
  const CellResults cell = of_surveys(
      {{"a", {1.0, 5.0, 9.0, 2.0, 7.0, 3.0}}, {"b", {1.1, 5.12, 9.09, 2.11, 7.1, 3.08}}});
  const auto ranked = ranking(cell, kError, {.margin = 0.1});
  EXPECT_THAT(ranked->find("b")->p, Optional(DoubleNear(2.0 / 64.0, 1e-12)));
  EXPECT_EQ(ranked->find("b")->standing, Standing::equivalent);
}

// No reference knows a position to a picometre, even where the best error is 0.
TEST(Ranking, DifferencesBelowWhatTheUnitCanMeanAreNone) {
  for (const double best : {0.0, 1e-5}) {
    const CellResults cell = of_surveys(
        {{"a", std::vector<double>(8, best)}, {"b", std::vector<double>(8, best + 2.42e-16)}});
    const auto ranked = ranking(cell, kError);
    EXPECT_NEAR(ranked->margin, 1e-6, 1e-18);
    EXPECT_EQ(ranked->find("b")->standing, Standing::equivalent) << best;
  }
}

// Nor does one of them make a best.
TEST(Ranking, NobodyWinsByRounding) {
  const CellResults cell = of_surveys({{"far", std::vector<double>(8, 0.1)},
                                       {"a", std::vector<double>(8, 0.01 + 9e-7)},
                                       {"b", std::vector<double>(8, 0.01)},
                                       {"worse", std::vector<double>(8, 0.01 + 2e-6)}});
  const auto ranked = ranking(cell, kError, {.margin = 0.0});
  EXPECT_EQ(ranked->best().name, "a");
  EXPECT_EQ(ranked->find("b")->standing, Standing::equivalent);
  EXPECT_EQ(ranked->find("worse")->standing, Standing::worse);
  const auto answer = study_verdict(study_of({cell}, 8, 1)).answer;
  EXPECT_THAT(answer, ::testing::Contains(::testing::HasSubstr("b (less than 1.00 µm)")));
}

// Six surveys cannot tell three apart: with three pairs the least p is 3 · 2⁻⁵.
TEST(Ranking, GivesNoVerdictWhereNoPCanBeSmall) {
  EXPECT_EQ(fewest_draws(2), 6u);
  EXPECT_EQ(fewest_draws(3), 7u);
  EXPECT_EQ(fewest_draws(4), 8u);
  EXPECT_EQ(fewest_draws(10), 11u);
  const std::vector<double> six(kEight.begin(), kEight.begin() + 6);
  const auto three =
      ranking(of_surveys({{"a", six}, {"b", moved(six, 5.0, 0.1)}, {"c", six}}), kError);
  EXPECT_FALSE(three->gives_verdict());
  EXPECT_EQ(three->find("b")->standing, Standing::not_shown);
  EXPECT_EQ(three->find("c")->standing, Standing::not_shown);
  EXPECT_THAT(three->find("b")->p, Optional(DoubleNear(3.0 / 32.0, 1e-12)));
}

// Trials of one survey that was drawn say nothing of another; those of a log are draws.
TEST(Ranking, TheTrialsOfOneSurveyGiveNoVerdict) {
  CellResults cell = cell_of({made("a", kEight), made("b", moved(kEight, 1.0, 0.1))});
  EXPECT_FALSE(ranking(cell, kError)->gives_verdict());
  EXPECT_EQ(ranking(cell, kError)->find("b")->standing, Standing::not_shown);
  cell.repetition = Repetition::logs;
  EXPECT_EQ(ranking(cell, kError)->draws, 8u);
  EXPECT_EQ(ranking(cell, kError)->find("b")->standing, Standing::worse);
}

// One wild survey makes the mean worse where seven of eight are better.
TEST(Ranking, MeanAndRanksMustAgree) {
  std::vector<double> wild = moved(kEight, -0.2, -0.01);
  std::vector<double> nine = kEight;
  for (const double value : {1.0, 1.1}) {
    nine.push_back(value);
    wild.push_back(value - 0.2);
  }
  nine.push_back(1.0);
  wild.push_back(9.0);
  const auto ranked = ranking(of_surveys({{"a", nine}, {"wild", wild}}), kError);
  EXPECT_EQ(ranked->best().name, "a");
  EXPECT_EQ(ranked->find("wild")->standing, Standing::not_shown);
}

TEST(Ranking, IntervalsHoldTogether) {
  std::vector<std::pair<std::string, std::vector<double>>> two{
      {"a", kEight}, {"b", {1.5, 1.1, 1.3, 1.2, 1.9, 0.9, 1.2, 1.1}}};
  auto six = two;
  for (const char* name : {"c", "d", "e", "f"}) six.emplace_back(name, moved(kEight, 2.0, 0.1));
  const auto of_two = ranking(of_surveys(two), kError);
  const auto of_six = ranking(of_surveys(six), kError);
  EXPECT_DOUBLE_EQ(of_two->level, 0.95);
  EXPECT_DOUBLE_EQ(of_six->level, 0.99);  // five differences
  const Interval narrow = *of_two->find("b")->difference->interval;
  const Interval wide = *of_six->find("b")->difference->interval;
  EXPECT_LT(wide.low, narrow.low);
  EXPECT_GT(wide.high, narrow.high);
  // Exact: the eight differences of c have one sign, so 2 · 2⁻⁸; of fifteen pairs, by Holm.
  EXPECT_THAT(of_six->find("c")->p, Optional(DoubleNear(15.0 * 2.0 / 256.0, 1e-12)));
}

// The exact level of the test: of estimators that are alike at most one study in twenty has a worse
// one. Of 400 studies a rate of 5 % gives more than 31 in 1 of 100.
TEST(Ranking, EstimatorsThatAreAlikeAreRarelyWorse) {
  RandomStream random(7, "alike");
  constexpr int kStudies = 400;
  for (const std::size_t estimators : {2, 3, 5}) {
    int wrong = 0;
    for (int study = 0; study < kStudies; ++study) {
      std::vector<std::pair<std::string, std::vector<double>>> drawn(estimators);
      for (std::size_t e = 0; e < estimators; ++e) drawn[e].first = std::to_string(e);
      for (std::size_t s = 0; s < fewest_draws(estimators) + 2; ++s) {
        const double of_survey = std::exp(random.normal());
        for (auto& [name, errors] : drawn) {
          errors.push_back(of_survey * std::exp(random.normal()));
        }
      }
      const auto ranked = ranking(of_surveys(drawn), kError, {.margin = 0.0});
      ASSERT_TRUE(ranked->gives_verdict());
      if (!ranked->standing(Standing::worse).empty()) ++wrong;
    }
    EXPECT_LE(wrong, 31) << estimators;
  }
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
  EXPECT_EQ(ranking(cell, "loop_precision", {.names = {"few"}})->best().name, "few");
  EXPECT_FALSE(ranking(cell, "anees"));
}

TEST(Ranking, OfEqualsTheFirstIsBestAndTheOthersAreEquivalent) {
  const auto ranked = ranking(of_surveys({{"a", kEight}, {"b", kEight}}), kError);
  EXPECT_EQ(ranked->best().name, "a");
  EXPECT_EQ(ranked->find("b")->standing, Standing::equivalent);
  EXPECT_EQ(ranked->find("b")->p, std::nullopt);
}

}  // namespace
}  // namespace fathom::test
