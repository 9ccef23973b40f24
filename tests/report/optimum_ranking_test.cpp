#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "report/made_cells.hpp"
#include "src/report/ranking.hpp"
#include "src/report/regime_map.hpp"

namespace fathom::test {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr const char* kGap = "chi2_gap";
constexpr double kDegrees = 300.0;

// Eight surveys whose F lies so far above its optimum; no ground truth.
EstimatorResults above_optimum(const std::string& name, double gap, double optimum) {
  EstimatorResults one = eight(name, std::vector<double>(8, gap));
  one.metrics[kGap] = one.metrics.at(kError);
  one.metrics.erase(kError);
  for (RunRecord& run : one.runs) {
    run.metrics[kGap] = gap + 0.01 * static_cast<double>(run.key.survey);
    run.metrics.erase(kError);
  }
  one.consistency[kGap].moments.mean = gap;
  one.consistency[kGap].interval = Interval{0.9 * gap, 1.1 * gap};
  one.consistency["chi2_optimum"].moments.mean = optimum;
  one.consistency["degrees_of_freedom"].moments.mean = kDegrees;
  return one;
}

// One that keeps all loops and one that leaves some out.
CellResults without_truth(double optimum_per_degree) {
  return surveyed({above_optimum("keeps", 0.5, optimum_per_degree * kDegrees),
                   above_optimum("rejects", 2000.0, optimum_per_degree * kDegrees)});
}

StudyResults study_without_truth(std::vector<CellResults> cells) {
  StudyResults results = study_of(std::move(cells), 8, 1);
  results.study.metrics = {kError, kGap, "total_ms"};
  return results;
}

TEST(RankingByTheOptimum, HoldsWhereMeasurementsFitEachOther) {
  const StudyResults results = study_without_truth({without_truth(1.1)});
  EXPECT_EQ(ranking_metric(results).name, kGap);
  EXPECT_THAT(study_verdict(results).answer,
              Contains(HasSubstr("Lowest F above the optimum: keeps")));
  EXPECT_THAT(study_verdict(results).doubts,
              Contains(HasSubstr("F above the optimum of the measurements: rejects by 2000")));
}

// The optimum of all loops holds the false ones: nearest to it is who kept them.
TEST(RankingByTheOptimum, IsRefusedWhereTheyDoNot) {
  const CellResults cell = without_truth(30.0);
  const StudyVerdict verdict = study_verdict(study_without_truth({cell}));
  EXPECT_FALSE(verdict.metric);
  EXPECT_THAT(verdict.answer,
              ElementsAre("Not ranked by F above the optimum: where measurements do not fit each "
                          "other (F per degree of freedom 30.0 at its best), F is least of an "
                          "estimator that keeps all loops, false ones too."));
  EXPECT_THAT(verdict.cost_words, IsEmpty());
  EXPECT_THAT(verdict.doubts, AllOf(Contains(HasSubstr("do not fit each other")),
                                    Not(Contains(HasSubstr("above the optimum")))));
  EXPECT_FALSE(ranking(cell, kGap));
  EXPECT_THAT(relative_to_best(cell, kGap), IsEmpty());
}

TEST(RankingByTheOptimum, IsRefusedToAllCellsForOne) {
  const StudyVerdict verdict =
      study_verdict(study_without_truth({without_truth(1.1), without_truth(30.0)}));
  EXPECT_FALSE(verdict.metric);
  EXPECT_THAT(verdict.answer, ElementsAre(HasSubstr("Not ranked by F above the optimum")));
  EXPECT_FALSE(verdict.cells[0].ranking);
}

TEST(RankingByTheOptimum, TheNextMetricRanks) {
  CellResults cell = without_truth(30.0);
  for (EstimatorResults& one : cell.estimators) {
    one.metrics["held_out_position_error_m"] = one.metrics.at(kGap);
    for (RunRecord& run : one.runs) {
      run.metrics["held_out_position_error_m"] = one.name == "keeps" ? 2.0 : 0.1;
    }
    one.metrics["held_out_position_error_m"].moments.mean = one.name == "keeps" ? 2.0 : 0.1;
  }
  StudyResults results = study_without_truth({cell});
  results.study.metrics = {kGap, "held_out_position_error_m"};
  const StudyVerdict verdict = study_verdict(results);
  EXPECT_EQ(verdict.metric, "held_out_position_error_m");
  ASSERT_GE(verdict.answer.size(), 2u);
  EXPECT_THAT(verdict.answer[0], HasSubstr("Not ranked by F above the optimum"));
  EXPECT_THAT(verdict.answer[1], HasSubstr("rejects"));
}

TEST(RankingByTheOptimum, IsRefusedWhereEstimatorsMinimiseAnotherF) {
  CellResults cell = without_truth(1.1);
  cell.estimators[0].consistency["estimates_shared_errors"].moments.mean = 1.0;
  cell.estimators[1].consistency["estimates_shared_errors"].moments.mean = 0.0;
  EXPECT_THAT(no_ranking_text(cell, kGap), HasSubstr("share errors"));
  EXPECT_THAT(no_ranking_text(cell, kError), IsEmpty());
  cell.estimators[1].consistency["estimates_shared_errors"].moments.mean = 1.0;
  EXPECT_THAT(no_ranking_text(cell, kGap), IsEmpty());
}

}  // namespace
}  // namespace fathom::test
