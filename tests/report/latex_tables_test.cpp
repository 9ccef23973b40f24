#include "src/report/latex_tables.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "report/made_cells.hpp"

namespace fathom::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

// Two of eight runs lack the metric, three closed no loop.
CellResults with_gaps() {
  CellResults cell = surveyed({eight("whole", kBest), eight("gaps", kAlike)});
  EstimatorResults& gaps = cell.estimators[1];
  gaps.metrics.at(kError).moments.count = 6;
  for (std::size_t i = 0; i < 3; ++i) gaps.runs[i].metrics["loop_closures"] = 0.0;
  return cell;
}

// A mean over some of the runs, or over runs that are dead reckoning, says so in a paper too.
TEST(LatexTables, ACellSaysOverHowManyRunsAMeanIs) {
  const std::string tex = latex_tables(study_of({with_gaps()}, 8, 1));
  EXPECT_THAT(tex, AllOf(HasSubstr("whole & 8/8 & "), HasSubstr("gaps & 8/8, 3 without loops & "),
                         HasSubstr(" {\\scriptsize $n = 6$}")));
  EXPECT_THAT(tex, Not(HasSubstr("$n = 8$")));
}

// Done, and not what it would be when it had converged: the terminal says so too.
TEST(LatexTables, ACellSaysHowManyRunsStoppedAtTheirLimit) {
  CellResults cell = with_gaps();
  cell.estimators[1].outcomes = {{"converged", 6}, {"iteration_limit", 2}};
  EXPECT_THAT(latex_tables(study_of({cell}, 8, 1)),
              HasSubstr("gaps & 8/8, 2 at iteration limit, 3 without loops & "));
}

TEST(LatexTables, AMetricOfManyCellsLikewise) {
  const std::vector<CellResults> cells(7, with_gaps());
  StudyResults results = study_of(cells, 8, 1);
  results.study.estimators = {{"whole", "ekf"}, {"gaps", "ekf"}};
  const std::string tex = latex_tables(results);
  EXPECT_THAT(tex, HasSubstr(" {\\scriptsize $n = 6$} (8/8, 3 without loops)"));
  EXPECT_THAT(tex, HasSubstr("In parentheses how many of the trials were done, where not all with "
                             "loops."));
  EXPECT_THAT(tex, Not(HasSubstr("(8/8)")));
}

}  // namespace
}  // namespace fathom::test
