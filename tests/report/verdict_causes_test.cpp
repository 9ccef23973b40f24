// Doubts by figures of runs, and why estimators are overconfident, where several are.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "report/made_cells.hpp"

namespace fathom::test {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

EstimatorResults overconfident(const std::string& name, HonestyCause cause, double figure) {
  EstimatorResults one = eight(name, kBest);
  one.honesty = Honesty{true, cause};
  one.consistency["anees"].moments.mean = 5.0;
  one.consistency["chi2_per_dof"].moments.mean = figure;
  one.consistency["mean_nis_truth"].moments.mean = figure;
  return one;
}

TEST(VerdictCauses, EachIsThatOfItsEstimator) {
  EXPECT_THAT(doubts_of_one(surveyed({overconfident("a", HonestyCause::misfit, 2.0),
                                      overconfident("b", HonestyCause::unknown, 2.0),
                                      overconfident("c", HonestyCause::small_registrations, 9.0)})),
              ElementsAre("Overconfident, where 1 is expected: a (ANEES 5.00), b (ANEES 5.00) and "
                          "c (ANEES 5.00). a: F per degree of freedom is 2.0: covariances of the "
                          "log are too small, or loops are false. c: The covariances of the "
                          "registrations are too small, or some are wrong: their mean NIS against "
                          "truth is 9.0, where "
                          "3 is expected."));
}

TEST(VerdictCauses, OneThatAllShareIsGivenOnce) {
  EXPECT_THAT(doubts_of_one(surveyed({overconfident("a", HonestyCause::misfit, 2.0),
                                      overconfident("b", HonestyCause::misfit, 2.0)})),
              ElementsAre("Overconfident, where 1 is expected: a (ANEES 5.00) and b (ANEES 5.00). "
                          "F per degree of freedom is 2.0: covariances of the log are too small, "
                          "or loops are false."));
}

// Each by its own number of cells, where that is not all of those.
TEST(VerdictCauses, OfSeveralCellsEstimatorsAreNamed) {
  const auto doubts_of_two = [](const EstimatorResults& of_second) {
    const CellResults first = surveyed({overconfident("a", HonestyCause::misfit, 2.0), of_second});
    const CellResults second = surveyed({eight("a", kBest), of_second});
    return study_verdict(study_of({first, second}, 8, 1)).doubts;
  };
  EXPECT_THAT(doubts_of_two(overconfident("b", HonestyCause::misfit, 2.0)),
              ElementsAre("In all 2 cells estimators are overconfident: a in 1 and b in 2."));
  EXPECT_THAT(doubts_of_two(eight("b", kBest)),
              ElementsAre("In 1 of 2 cells estimators are overconfident: a."));
}

TEST(VerdictCauses, WhatConsidersSharedErrorsIsNotHeldToTheOptimum) {
  EstimatorResults filter = eight("filter", kBest);
  MetricSummary& gap = filter.consistency["chi2_gap"];
  gap.moments.mean = 30.0;
  gap.interval = Interval{9.4, 50.0};
  filter.consistency["degrees_of_freedom"].moments.mean = 300.0;
  filter.consistency["estimates_shared_errors"].moments.mean = 0.0;
  EXPECT_THAT(doubts_of_one(surveyed({filter})),
              Contains(StartsWith("F above the optimum of the measurements: filter")));
  filter.considers_shared_errors = true;
  EXPECT_THAT(doubts_of_one(surveyed({filter})), IsEmpty());
}

TEST(VerdictCauses, MeasurementsThatDoNotFitEachOtherAreADoubt) {
  EstimatorResults one = eight("best", kBest);
  one.consistency["registrations"].moments.mean = 100.0;
  const auto with = [&](double chi2_optimum) {
    one.consistency["chi2_optimum"].moments.mean = chi2_optimum;
    return doubts_of_one(surveyed({one}));
  };
  EXPECT_THAT(with(9000.0), Contains(HasSubstr("F per degree of freedom is 30.0 at its best")));
  EXPECT_THAT(with(899.0), Not(Contains(HasSubstr("do not fit"))));
  one.consistency["degrees_of_freedom"].moments.mean = 1200.0;
  EXPECT_THAT(with(6000.0), Contains(HasSubstr("F per degree of freedom is 5.00 at its best")));
}

TEST(VerdictCauses, TimeThatIsNotOfAProcessorIsADoubt) {
  EstimatorResults busy = eight("busy", kBest, 8.0);
  EstimatorResults idle = eight("idle", kAlike, 4.0);
  for (RunRecord& run : busy.runs) run.metrics["cpu_ms"] = 0.5 * run.metrics.at("total_ms");
  for (RunRecord& run : idle.runs) run.metrics["cpu_ms"] = 0.9 * run.metrics.at("total_ms");
  EXPECT_THAT(doubts_of_one(surveyed({busy, idle})),
              ElementsAre("Of the time of busy 50 % was processor time: the machine was busy with "
                          "something else, or they wait for another process or a device; times are "
                          "comparable where nothing else runs."));
  EXPECT_THAT(doubts_of_one(surveyed({idle, eight("best", kBest, 8.0)})), IsEmpty());
}

}  // namespace
}  // namespace fathom::test
