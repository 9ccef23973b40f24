#include "src/report/verdict.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "report/made_cells.hpp"

namespace fathom::test {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

TEST(Verdict, SaysWhichIsBestWhichIsEquivalentWhichIsWorseAndWhatIsNotShown) {
  const StudyVerdict verdict = study_verdict(
      study_of({surveyed({eight(kDeadReckoning, {1.0, 1.1, 0.9, 1.2, 1.0, 1.1, 1.05, 1.05}),
                          eight("best", kBest), eight("unclear", kAlike), eight("worse", kWorse)})},
               8, 1));
  ASSERT_EQ(verdict.answer.size(), 4u);
  EXPECT_EQ(verdict.metric, kError);  // ANEES says not which is better
  EXPECT_THAT(verdict.answer[0], StartsWith("Lowest mean position error: best, 10.5 mm ["));
  EXPECT_THAT(verdict.answer[1], StartsWith("Not shown to differ from best: unclear (+"));
  EXPECT_THAT(verdict.answer[1], AllOf(HasSubstr(" mm [-"), HasSubstr("], p 0.")));
  EXPECT_THAT(verdict.answer[2], AllOf(StartsWith("Worse: worse by 3.1"),
                                       HasSubstr("] (30 % of the best), p 0.023.")));
  EXPECT_THAT(verdict.answer[3], StartsWith("Dead reckoning: 1.05 m, 100 times the lowest."));
  EXPECT_THAT(verdict.rule, HasSubstr("hold together with 95 %"));
}

TEST(Verdict, ADifferenceThatIsSmallBesideTheBestIsNone) {
  std::vector<double> close = kBest;
  for (std::size_t i = 0; i < close.size(); ++i) close[i] += 1e-5 + 1e-7 * static_cast<double>(i);
  StudyResults results = study_of({surveyed({eight("best", kBest), eight("close", close)})}, 8, 1);
  EXPECT_THAT(study_verdict(results).answer[1],
              StartsWith("Equivalent to best, within 0.105 mm: close (+0.0104 mm ["));
  EXPECT_EQ(study_verdict(results).answer[2],
            "8 draws need not show what goes wrong in one of 2.7.");
  results.study.margin = 0.0005;
  EXPECT_THAT(study_verdict(results).answer[1], StartsWith("Worse: close by 0.0104 mm ["));
}

TEST(Verdict, ADifferenceOfRoundingHasNoDigits) {
  std::vector<double> close = kBest, same = kBest;
  for (std::size_t i = 0; i < close.size(); ++i) {
    close[i] += 1e-5 + 1e-7 * static_cast<double>(i);
    same[i] += 3e-13 + 1e-14 * static_cast<double>(i);
  }
  const CellResults cell =
      surveyed({eight("best", kBest), eight("close", close), eight("same", same)});
  EXPECT_THAT(study_verdict(study_of({cell}, 8, 1)).answer[1],
              AllOf(HasSubstr("+0.0104 mm ["), HasSubstr("same (less than 1.00 µm)")));
}

TEST(Verdict, OfFewSurveysThereIsNone) {
  const auto first = [](const std::vector<double>& all) {
    return std::vector<double>(all.begin(), all.begin() + 5);
  };
  const StudyVerdict verdict = study_verdict(
      study_of({surveyed({eight("best", first(kBest)), eight("worse", first(kWorse))})}, 5, 1));
  EXPECT_EQ(verdict.answer[1],
            "No verdict: with 5 surveys no difference between 2 estimators can be shown; 6 are "
            "needed.");
  EXPECT_THAT(verdict.answer[2], StartsWith("Differences to best: worse (+"));
  EXPECT_EQ(verdict.rule, "");
}

TEST(Verdict, TheCheapestIsOneOfTheGoodOnes) {
  const StudyVerdict verdict =
      study_verdict(study_of({surveyed({eight("best", kBest, 8.0), eight("alike", kAlike, 0.0035),
                                        eight("worse", kWorse, 0.001)})},
                             6, 1));
  EXPECT_EQ(verdict.cells[0].by_cost->best().name, "alike");
  EXPECT_THAT(
      verdict.cost_words,
      ElementsAre("Cheapest of those within 5 % of the best: alike, estimate, time 0.00350 ms. "
                  "Dearer: best 8.00 ms."));
}

TEST(Verdict, FailuresAreCountedAndNotRanked) {
  EstimatorResults failed = eight("failed", std::vector<double>(8, 0.001));
  failed.runs[0].outcome = "diverged";
  failed.runs[1].outcome = "numerical_failure";
  failed.runs[2].metrics["loop_closures"] = 0.0;
  failed.outcomes = {{"converged", 6}, {"diverged", 1}, {"numerical_failure", 1}};
  failed.done = 6;
  const StudyVerdict verdict =
      study_verdict(study_of({surveyed({failed, eight("best", kBest)})}, 9, 1));
  EXPECT_THAT(verdict.answer[0], StartsWith("Only one is ranked by mean position error: best, "));
  EXPECT_THAT(
      verdict.failed,
      ElementsAre("failed failed in 2 of 8 runs (1 diverged and 1 numerical failure) and is "
                  "not ranked.",
                  "failed closed no loop in 1 of 8 runs.", "failed: 1 of 9 runs are missing.",
                  "best: 1 of 9 runs are missing."));
  EXPECT_THAT(verdict.doubts, Contains(StartsWith("The means of failed hold runs without loop")));
}

TEST(Verdict, FewSurveysAreADoubt) {
  const auto first = [](const std::vector<double>& all, std::size_t count) {
    return std::vector<double>(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count));
  };
  const auto doubts = [&](std::size_t count) {
    return doubts_of_one(
        surveyed({eight("best", first(kBest, count)), eight("b", first(kAlike, count))}));
  };
  EXPECT_THAT(doubts(4), Contains("Only 4 surveys: others may give another order."));
  EXPECT_THAT(doubts(5), IsEmpty());
  CellResults one = cell_of({made("best", kBest), made("b", kAlike)});
  EXPECT_THAT(doubts_of_one(one), ElementsAre(StartsWith("One survey: intervals over its trials")));
  one.repetition = Repetition::logs;
  EXPECT_THAT(doubts_of_one(one), IsEmpty());
  EXPECT_THAT(doubts_of_one(cell_of({made("best", {1.0}), made("b", {2.0})})),
              ElementsAre(StartsWith("A single trial")));
}

TEST(Verdict, DeadReckoningThatIsAsGoodIsADoubt) {
  EXPECT_THAT(doubts_of_one(surveyed({eight(kDeadReckoning, kAlike), eight("best", kBest)})),
              ElementsAre(StartsWith("The best is not shown to be better than dead")));
  EXPECT_THAT(doubts_of_one(surveyed({eight(kDeadReckoning, kWorse), eight("best", kBest)})),
              IsEmpty());
}

TEST(Verdict, AContenderThatSelectsAndJobsAreDoubts) {
  CellResults cell = surveyed({eight("best", kBest), eight("alike", kAlike)});
  cell.selected_by = "the estimate of ekf, no contender";
  cell.jobs = {1};
  EXPECT_THAT(doubts_of_one(cell), IsEmpty());
  StudyDescription study;
  study.configuration = {{"association.mode", "shared"},
                         {"association.reference", "best"},
                         {"dataset.type", "simulated"}};
  cell.selected_by = study.selected_by(0);
  cell.contender_selects = study.selector_of(0).kind == LoopSelector::Kind::contender;
  cell.jobs = {1, 2};
  EXPECT_THAT(doubts_of_one(cell),
              ElementsAre(HasSubstr("selected by the estimate of best, a contender"),
                          "Costs were measured with 1, 2 jobs at a time; they are comparable at 1 "
                          "alone."));
}

TEST(Verdict, WordsOfConsistencyAndTheOptimumAreDoubts) {
  EstimatorResults over = eight("over", kBest);
  over.honesty = Honesty{true, HonestyCause::misfit, false, false};
  over.consistency["chi2_per_dof"].moments.mean = 2.0;
  over.consistency["anees"].moments.mean = 5.0;
  MetricSummary& gap = over.consistency["chi2_gap"];
  gap.moments.mean = 30.0;
  gap.interval = Interval{9.4, 50.0};
  EstimatorResults near = eight("near", kAlike);
  near.consistency["chi2_gap"].moments.mean = 30.0;
  near.consistency["chi2_gap"].interval = Interval{9.3, 50.0};
  EXPECT_THAT(
      doubts_of_one(surveyed({over, near})),
      ElementsAre("Overconfident, where 1 is expected: over (ANEES 5.00). F per degree of "
                  "freedom is 2.0: covariances of the log are too small, or loops are false.",
                  "F above the optimum of the measurements: over by 30.0 [9.40, 50.0]."));
}

TEST(Verdict, ErrorsThatRegistrationsShareAreADoubt) {
  EstimatorResults one = eight("one", kBest);
  MetricSummary& correlation = one.consistency["picture_error_correlation"];
  correlation.moments.mean = 0.26;
  correlation.interval = Interval{0.2, 0.31};
  const EstimatorResults other = eight("other", kAlike);
  EXPECT_THAT(doubts_of_one(surveyed({one, other})),
              ElementsAre("Registrations of one picture share errors (correlation 0.260 [0.200, "
                          "0.310]), which one does not estimate."));
  correlation.interval = Interval{-0.01, 0.31};
  EXPECT_THAT(doubts_of_one(surveyed({one, other})), IsEmpty());
}

TEST(Verdict, WhereLoopsAreMissingTheFrontEndSaysWhy) {
  EstimatorResults one = eight("best", kBest);
  for (RunRecord& run : one.runs) {
    run.metrics["loop_closures"] = 0.0;
    run.metrics["registrations"] = 0.0;
    run.metrics["registrations_tried"] = 610.0;
  }
  EXPECT_THAT(doubts_of_one(surveyed({one})),
              Contains(HasSubstr("of 610 candidate pairs a trial 0 registered")));
  for (RunRecord& run : one.runs) run.metrics["registrations_tried"] = 0.0;
  EXPECT_THAT(doubts_of_one(surveyed({one})), Contains(HasSubstr("there were no candidate pairs")));
}

TEST(Verdict, FewLoopsAmongTheOverlappingPairsAreADoubt) {
  EstimatorResults one = eight("best", kBest);
  const auto with = [&](double recall, double left_out) {
    for (RunRecord& run : one.runs) {
      run.metrics["loop_recall"] = recall;
      run.metrics["registrations_left_out"] = left_out;
    }
    return doubts_of_one(surveyed({one}));
  };
  EXPECT_THAT(with(0.21, 0.0), Contains(HasSubstr("no more than 21 % are loops")));
  EXPECT_THAT(with(0.51, 0.0), Not(Contains(HasSubstr("overlap well"))));
  EXPECT_THAT(with(0.21, 3.0), Not(Contains(HasSubstr("overlap well"))));
}

TEST(Verdict, SeveralCellsAreSummedUp) {
  CellResults alike = surveyed({eight("best", kBest), eight("other", kAlike)});
  CellResults apart = surveyed({eight("best", kBest), eight("other", kWorse)});
  alike.label = "noise 1";
  apart.label = "noise 2";
  apart.estimators[1].runs[0].metrics["loop_closures"] = 0.0;
  const StudyVerdict verdict = study_verdict(study_of({alike, apart}, 8, 1));
  ASSERT_EQ(verdict.answer.size(), 2u);
  EXPECT_EQ(verdict.answer[0],
            "By mean position error an estimator is worse than the best in 1 of 2 cells.");
  EXPECT_THAT(verdict.answer[1], StartsWith("other is worse in 1 of 2 cells, most at noise 2: by "
                                            "3.11 mm ["));
  EXPECT_THAT(verdict.cost_words,
              ElementsAre(HasSubstr("best in all 2 cells; estimate, time 1.00"),
                          "In 1 of 2 cells others as good are not shown to be dearer."));
  EXPECT_THAT(verdict.failed,
              ElementsAre("other closed no loop in 1 of 16 runs, in 1 of 2 cells."));
  EXPECT_THAT(verdict.doubts,
              ElementsAre("In 1 of 2 cells means hold runs without loop closures: other."));
  EXPECT_THAT(verdict_text(verdict), AllOf(StartsWith("Verdict\nBy mean position error"),
                                           HasSubstr("\nDoubt: In 1 of 2 cells means")));
}

TEST(Verdict, WithoutAMetricThatRanksNothingIsRanked) {
  StudyResults results = study_of({surveyed({eight("a", kBest), eight("b", kWorse)})}, 8, 1);
  results.study.metrics = {"anees", "total_ms"};
  const StudyVerdict verdict = study_verdict(results);
  EXPECT_THAT(
      verdict.answer,
      ElementsAre("Not ranked: no metric of this study that says which is better has a value."));
  EXPECT_THAT(verdict.cost_words, IsEmpty());
  EXPECT_THAT(verdict_text(verdict), Not(HasSubstr("Worse")));
}

}  // namespace
}  // namespace fathom::test
