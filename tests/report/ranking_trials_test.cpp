// Over which trials estimators are ranked, and what counts as a draw.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "report/made_cells.hpp"
#include "src/report/contenders.hpp"

namespace fathom::test {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

const std::vector<double> kErrors{1.0, 1.2, 0.9, 1.1, 1.0, 1.1, 1.3, 0.8};

// Worse by about 1 m.
std::vector<double> worse() {
  std::vector<double> values = kErrors;
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] += 1.0 + 0.1 * static_cast<double>(i % 3);
  return values;
}

// What one mean is of hard trials and another is not says nothing: who lacks the metric where
// others have it is not ranked.
TEST(RankingTrials, WhoLacksTheMetricInATrialIsLeftOut) {
  EstimatorResults partly = made("partly", kErrors, true);
  for (std::size_t s = 5; s < 8; ++s) partly.runs[s].metrics.erase(kError);
  partly.metrics[kError].moments = *moments(std::vector<double>{1.0, 1.2, 0.9, 1.1, 1.0});
  const auto ranked = ranking(surveyed({partly, made("all", worse(), true)}), kError);
  ASSERT_EQ(ranked->estimators.size(), 1u);
  EXPECT_EQ(ranked->best().name, "all");
  ASSERT_EQ(ranked->left_out.size(), 1u);
  EXPECT_EQ(ranked->left_out[0].name, "partly");
  EXPECT_EQ(ranked->left_out[0].without, 3u);
  EXPECT_EQ(ranked->left_out[0].trials, 8u);
}

// Of a study that is not finished, means are over the trials that all have run.
TEST(RankingTrials, MeansAreOverTheTrialsThatAllHaveRun) {
  std::vector<double> hard_end = kErrors;
  hard_end.insert(hard_end.end(), 4, 50.0);
  const auto ranked =
      ranking(surveyed({made("longer", hard_end, true), made("shorter", worse(), true)}), kError);
  ASSERT_EQ(ranked->estimators.size(), 2u);
  EXPECT_EQ(ranked->best().name, "longer");
  EXPECT_NEAR(ranked->best().summary.moments.mean, 1.05, 1e-12);
  EXPECT_EQ(ranked->find("shorter")->standing, Standing::worse);
}

// So are differences, and what counts as draws.
TEST(RankingTrials, DifferencesAreOverTheSameTrialsAsMeans) {
  std::vector<double> best = kErrors;
  std::vector<double> second = worse();
  best.insert(best.end(), 4, 1.0);
  second.insert(second.end(), 4, 50.0);
  const auto ranked = ranking(surveyed({made("best", best, true), made("second", second, true),
                                        made("late", worse(), true)}),
                              kError);
  for (const char* const name : {"second", "late"}) {
    const RankedEstimator* const one = ranked->find(name);
    EXPECT_NEAR(one->difference->mean,
                one->summary.moments.mean - ranked->best().summary.moments.mean, 1e-12)
        << name;
    EXPECT_EQ(one->difference->count, 8u) << name;
  }
  EXPECT_EQ(ranked->draws, 8u);
}

// Of a program that sums in any order.
TEST(RankingTrials, RepeatsThatDifferByRoundingAreOneResult) {
  std::vector<double> a;
  std::vector<double> b;
  for (int i = 0; i < 8; ++i) {
    a.push_back(907947.0 * (1.0 + 1e-13 * i));
    b.push_back(2e-9 * (1.0 + 1e-12 * (i % 3)));
  }
  CellResults cell = cell_of({made("a", a), made("b", b)});
  for (EstimatorResults& one : cell.estimators) {
    for (RunRecord& run : one.runs) run.log_hash = "one log";
  }
  const auto ranked = ranking(cell, kError);
  EXPECT_TRUE(ranked->repeats_one_result);
  EXPECT_EQ(ranked->draws, 1u);
}

TEST(RankingTrials, OverSeveralCellsItIsSaidToo) {
  EstimatorResults partly = made("partly", kErrors, true);
  partly.runs[5].metrics.erase(kError);
  const auto verdict = study_verdict(
      study_of({surveyed({partly, made("all", worse(), true)}),
                surveyed({made("partly", kErrors, true), made("all", worse(), true)})},
               8, 1));
  EXPECT_THAT(verdict.answer,
              Contains("partly has no mean position error in some trials of 1 of 2 cells, where it "
                       "is not ranked by it."));
}

// One trial in common is no repetition of one result.
TEST(RankingTrials, OneTrialInCommonIsASingleTrial) {
  CellResults cell = cell_of({made("a", kErrors), made("b", {2.0})});
  for (EstimatorResults& one : cell.estimators) {
    for (RunRecord& run : one.runs) run.log_hash = "log " + std::to_string(run.key.trial);
  }
  const auto ranked = ranking(cell, kError);
  EXPECT_FALSE(ranked->repeats_one_result);
  EXPECT_EQ(ranked->draws, 1u);
  const auto verdict = study_verdict(study_of({cell}, 1, 8));
  EXPECT_THAT(verdict.answer, Contains(StartsWith("No verdict: with 1 survey no")));
  EXPECT_THAT(verdict.doubts, ElementsAre(StartsWith("A single trial")));
}

// Beside the lowest, over the same trials.
TEST(RankingTrials, DeadReckoningIsOfTheTrialsThatAreRanked) {
  const CellResults cell =
      cell_of({made(kDeadReckoning, {4.0, 40.0}), made("a", {1.0, 1.0}), made("b", {2.0})});
  EXPECT_THAT(study_verdict(study_of({cell}, 1, 2)).answer,
              Contains("Dead reckoning: 4.00 m, 4.0 times the lowest."));
}

// Trials of one measurement log repeat one result.
TEST(RankingTrials, RepeatsOfOneResultAreOneDraw) {
  CellResults cell =
      cell_of({made("a", std::vector<double>(10, 1.0)), made("b", std::vector<double>(10, 1.2))});
  cell.repetition = Repetition::logs;
  EXPECT_EQ(ranking(cell, kError)->find("b")->standing, Standing::worse);
  for (EstimatorResults& one : cell.estimators) {
    for (RunRecord& run : one.runs) run.log_hash = "the same";
  }
  const auto ranked = ranking(cell, kError);
  EXPECT_EQ(ranked->draws, 1u);
  EXPECT_TRUE(ranked->repeats_one_result);
  EXPECT_FALSE(ranked->gives_verdict());
  EXPECT_FALSE(ranked->find("b")->difference->interval);
}

// An estimator that draws says something else of the same log: then each trial is a draw.
TEST(RankingTrials, WhatAnEstimatorDrawsOnOneLogIsNoRepeat) {
  std::vector<double> drawn(9, 0.1);
  drawn.push_back(1.0);
  CellResults cell = cell_of({made("a", drawn), made("b", std::vector<double>(10, 0.3))});
  for (EstimatorResults& one : cell.estimators) {
    for (RunRecord& run : one.runs) run.log_hash = "the same";
  }
  const auto ranked = ranking(cell, kError);
  EXPECT_NEAR(ranked->best().summary.moments.mean, 0.19, 1e-12);
  EXPECT_FALSE(ranked->repeats_one_result);
  EXPECT_EQ(ranked->find("b")->difference->count, 10u);
  EXPECT_NEAR(ranked->find("b")->difference->mean, 0.11, 1e-12);
}

TEST(RankingTrials, SaysWhyNobodyIsRanked) {
  const RankingMetric by{kError, {}};
  const auto answer = [&](EstimatorResults one) {
    return cell_verdict(cell_of({std::move(one)}), {}, by, std::nullopt).answer;
  };
  EstimatorResults failed = made("a", kErrors);
  failed.done = 7;
  EXPECT_THAT(answer(failed), ElementsAre(HasSubstr("none did all its runs")));
  EstimatorResults without = made("a", kErrors);
  without.metrics.clear();
  for (RunRecord& run : without.runs) run.metrics.clear();
  EXPECT_THAT(answer(without), ElementsAre(HasSubstr("no run here has a mean position error")));
}

}  // namespace
}  // namespace fathom::test
