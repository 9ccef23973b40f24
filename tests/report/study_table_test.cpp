#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/report/study_report.hpp"
#include "fathom/report/table.hpp"
#include "report/study_fixture.hpp"
#include "support/temporary_folder.hpp"

namespace fathom::test {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

std::string table_of(const FixtureOptions& options) {
  const TemporaryFolder folder;
  write_fixture(folder.path(), options);
  return study_table(ResultStore::open(folder.path()));
}

// Errors 1, 2 and 3 of the first estimator, 2, 4 and a failure of the second.
ResultStore small_store(const TemporaryFolder& folder) {
  StudyDescription study;
  study.alignment = "se2";
  study.trials = 4;
  study.estimators = {{"first", "ekf"}, {"second", "ekf"}};
  study.metrics = {"ate_rmse_m"};
  ResultStore store = ResultStore::write(folder.path(), study, "{}");
  const auto add = [&store](std::size_t trial, const char* name, double error,
                            const char* outcome) {
    RunRecord run;
    run.key = {0, 0, trial, name};
    run.outcome = outcome;
    run.metrics = {{"ate_rmse_m", error}};
    store.add(run);
  };
  add(0, "first", 1.0, "converged");
  add(1, "first", 2.0, "iteration_limit");
  add(2, "first", 3.0, "converged");
  add(0, "second", 2.0, "converged");
  add(1, "second", 4.0, "converged");
  add(2, "second", 900.0, "diverged");
  store.finish();
  return ResultStore::open(folder.path());
}

TEST(StudyTable, SaysWhatWasNotDoneAndKeepsItOutOfTheMeans) {
  const TemporaryFolder folder;
  const std::string table = study_table(small_store(folder));
  EXPECT_THAT(table, HasSubstr("all: alignment se2, 1 survey × 4 trials (3 of 4), jobs 1\n"));
  EXPECT_THAT(table, ContainsRegex("first +3/3 done, 1 at iteration limit, 1 not run +2.00 \\["));
  EXPECT_THAT(table, ContainsRegex("second +2/3 done, 1 diverged, 1 not run +3.00 \\["));
  EXPECT_THAT(table, Not(HasSubstr("900")));
}

TEST(StudyTable, PairsAreTheTrialsThatBothDid) {
  const TemporaryFolder folder;
  // Differences 1 and 2: mean 1.5; both positive, so the exact two-sided p is 2 · (1/2)² = 0.5.
  EXPECT_THAT(study_table(small_store(folder)),
              ContainsRegex("second +ATE RMSE \\(m\\) +2 trials +1.50 \\[.*\\] +0.500 +0.500\n"));
}

// Survey 0 with the differences 1 and 3, survey 1 with 4, survey 2 with a pair that failed.
TEST(StudyTable, OfSeveralSurveysTheirMeansAreCompared) {
  const TemporaryFolder folder;
  StudyDescription study;
  study.surveys = 3;
  study.trials = 2;
  study.estimators = {{"first", "ekf"}, {"second", "ekf"}};
  study.metrics = {"ate_rmse_m"};
  {
    ResultStore store = ResultStore::write(folder.path(), study, "{}");
    const auto add = [&store](std::size_t survey, std::size_t trial, double difference) {
      for (const bool is_first : {true, false}) {
        RunRecord run;
        run.key = {0, survey, trial, is_first ? "first" : "second"};
        run.outcome = !is_first && difference > 100.0 ? "diverged" : "converged";
        run.metrics = {{"ate_rmse_m", is_first ? 1.0 : 1.0 + difference}};
        store.add(run);
      }
    };
    add(0, 0, 1.0);
    add(0, 1, 3.0);
    add(1, 0, 4.0);
    add(2, 0, 900.0);
    store.finish();
  }
  const std::string table = study_table(ResultStore::open(folder.path()));
  EXPECT_THAT(table, HasSubstr("all: 3 surveys × 2 trials (4 of 6), jobs 1\n"));
  // Means of the surveys 3 and 5, of the differences 2 and 4.
  EXPECT_THAT(table, ContainsRegex("second +3/4 done, 1 diverged, 2 not run +4.00 \\["));
  EXPECT_THAT(table,
              ContainsRegex("second +ATE RMSE \\(m\\) +2 surveys +3.00 \\[.*\\] +0.500 +0.500\n"));
  EXPECT_THAT(table, HasSubstr("Means over the surveys of the mean of each one's done"));
  EXPECT_THAT(table, Not(HasSubstr("One survey")));
}

TEST(StudyTable, SaysWhatTrialsOfOneSurveyDoNotSpeakOf) {
  FixtureOptions options;
  EXPECT_THAT(table_of(options), HasSubstr("One survey: intervals over its trials say nothing of"));
  options.data_set = "simulated_log";
  EXPECT_THAT(table_of(options), Not(HasSubstr("say nothing of")));
  EXPECT_THAT(table_of(options), HasSubstr("alignment origin, 6 trials, jobs 2\n"));
}

TEST(StudyTable, EndsWithTheVerdict) {
  FixtureOptions options;
  options.separations.clear();
  options.noises.clear();
  const std::string table = table_of(options);
  const std::size_t verdict = table.find("\nVerdict\nLowest mean position error: iterated, ");
  ASSERT_NE(verdict, std::string::npos);
  EXPECT_GT(verdict, table.find("p: signed-rank test"));
  EXPECT_THAT(table.substr(verdict), HasSubstr("\nDoubt: One survey: intervals over its trials"));
  EXPECT_THAT(table.substr(verdict), HasSubstr("\nNo verdict: with 1 survey no difference"));
}

TEST(StudyTable, DeadReckoningComesFirst) {
  const std::string table = table_of({});
  EXPECT_LT(table.find("dead reckoning"), table.find("iterated"));
  EXPECT_LT(table.find("\niterated"), table.find("\na&b_<c>%"));
}

TEST(StudyTable, OneTrialHasValuesWithoutIntervals) {
  FixtureOptions options;
  options.trials = 1;
  options.separations.clear();
  options.noises.clear();
  const std::string table = table_of(options);
  EXPECT_THAT(table, Not(HasSubstr("[")));
  EXPECT_THAT(table, Not(HasSubstr("minus")));
  EXPECT_THAT(table, HasSubstr("1 survey × 1 trial,"));
}

TEST(StudyTable, ACellWithoutAMetricLeavesItsColumnOut) {
  FixtureOptions options;
  options.ground_truth = false;
  const std::string table = table_of(options);
  EXPECT_THAT(table, Not(HasSubstr("position error")));
  EXPECT_THAT(table, HasSubstr("estimate, time (ms)"));
}

TEST(StudyTable, IsNoWiderThan160Columns) {
  const TemporaryFolder folder;
  StudyDescription study;
  study.trials = 2;
  study.estimators = {{"one", "ekf"}};
  RunRecord run;
  run.outcome = "converged";
  for (int i = 10; i < 30; ++i) {
    study.metrics.push_back("rpe_" + std::to_string(i) + "_keyframes_m");
    run.metrics[study.metrics.back()] = 1.0 + i;
  }
  {
    ResultStore store = ResultStore::write(folder.path(), study, "{}");
    for (std::size_t trial = 0; trial < 2; ++trial) {
      run.key = {0, 0, trial, "one"};
      store.add(run);
    }
    store.finish();
  }
  const std::string table = study_table(ResultStore::open(folder.path()));
  std::istringstream lines(table);
  std::size_t widest = 0;
  for (std::string line; std::getline(lines, line);) widest = std::max(widest, display_width(line));
  EXPECT_LE(widest, 160u);
  EXPECT_GT(widest, 100u);
  for (int i = 10; i < 30; ++i) {
    EXPECT_THAT(table, HasSubstr("RPE over " + std::to_string(i) + " keyframes (m)"));
  }
}

}  // namespace
}  // namespace fathom::test
