// Figures for who goes on with them: those of the tables.

#include "fathom/report/study_statistics.hpp"

#include <tuple>

#include <gtest/gtest.h>

#include "fathom/evaluation/clustered.hpp"
#include "support/temporary_folder.hpp"

namespace fathom::test {
namespace {

// Of 3 surveys of 4 trials: "near" is 0.1 from its survey's error, and "far" 0.1 beyond that, but
// in the last survey as near. Trials 0 of "near" and 1 of "far" diverged.
ResultStore stored_surveys(const TemporaryFolder& folder) {
  StudyDescription study;
  study.surveys = 3;
  study.trials = 4;
  study.estimators = {{"near", "ekf"}, {"far", "ekf"}};
  study.metrics = {"ate_rmse_m"};
  ResultStore store = ResultStore::write(folder.path(), study, "{}");
  for (std::size_t survey = 0; survey < 3; ++survey) {
    for (std::size_t trial = 0; trial < 4; ++trial) {
      const double near = static_cast<double>(survey) + (trial % 2 == 0 ? 0.1 : -0.1);
      const double far = near + (survey < 2 ? 0.1 : 0.0);
      for (const auto& [name, error, failed] :
           {std::tuple{"near", near, trial == 0}, std::tuple{"far", far, trial == 1}}) {
        RunRecord run;
        run.key = {0, survey, trial, name};
        run.outcome = failed ? "diverged" : "converged";
        run.metrics = {{"ate_rmse_m", failed ? 1e6 : error}};
        store.add(run);
      }
    }
  }
  store.finish();
  return ResultStore::open(folder.path());
}

TEST(StudyStatistics, ADifferenceIsOverSurveysAndCommonTrials) {
  const TemporaryFolder folder;
  const auto found = study_difference(stored_surveys(folder), "ate_rmse_m", "far", "near", 0);
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->is_over_surveys);
  EXPECT_EQ(found->count, 3u);
  EXPECT_EQ(found->trials, 6u);
  EXPECT_NEAR(found->mean, 0.2 / 3.0, 1e-12);
  // Two surveys that differ and one that does not: 2 of the 4 signs are as extreme.
  EXPECT_EQ(found->signed_rank.p_value, 0.5);
}

TEST(StudyStatistics, AnIntervalIsOverSurveys) {
  const TemporaryFolder folder;
  const auto found = study_interval(stored_surveys(folder), "ate_rmse_m", "near", 0);
  const ClusteredValues done{{0, {-0.1, 0.1, -0.1}}, {1, {0.9, 1.1, 0.9}}, {2, {1.9, 2.1, 1.9}}};
  const auto expected = hierarchical_interval(done);
  ASSERT_TRUE(found && expected);
  EXPECT_NEAR(found->low, expected->low, 1e-12);
  EXPECT_NEAR(found->high, expected->high, 1e-12);
}

TEST(StudyStatistics, WhatIsNotThereIsNothing) {
  const TemporaryFolder folder;
  const ResultStore store = stored_surveys(folder);
  EXPECT_FALSE(study_interval(store, "anees", "near", 0));
  EXPECT_FALSE(study_interval(store, "ate_rmse_m", "other", 0));
  EXPECT_FALSE(study_difference(store, "anees", "near", "far", 0));
  EXPECT_FALSE(study_difference(store, "ate_rmse_m", "near", "far", 1));
}

}  // namespace
}  // namespace fathom::test
