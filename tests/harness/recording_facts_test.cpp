#include "fathom/harness/recording_facts.hpp"

#include <gtest/gtest.h>

#include "fathom/core/hash.hpp"
#include "fathom/estimators/builtin.hpp"
#include "fathom/harness/result.hpp"
#include "fathom/measurements/g2o.hpp"
#include "harness/square_result.hpp"

namespace fathom {
namespace {

Result evaluated(const Recording& recording, const std::string& type, const RecordingFacts* facts) {
  return evaluate(recording, {type, type, {}}, builtin_estimators(),
                  {.metrics = {}, .facts = facts}, {});
}

TEST(RecordingFacts, TheOptimumIsTheLeastOfAllBatchSolves) {
  const Recording recording = test::square(false);
  const auto optimum = batch_optimum(recording.log, builtin_estimators());
  ASSERT_TRUE(optimum);
  EXPECT_EQ(chi2(recording.log, optimum->poses), optimum->chi2);
  EXPECT_LT(optimum->chi2, chi2(recording.log, recording.log.odometry()));
  std::size_t solvers = 0;
  for (const EstimatorEntry& entry : builtin_estimators().entries()) {
    if (!entry.can_batch) continue;
    ++solvers;
    ReplayOptions options;
    options.mode = SolveMode::batch;
    const auto solved = replay(recording.log, entry, {}, options);
    EXPECT_LE(optimum->chi2, chi2(recording.log, solved.trajectory)) << entry.name;
  }
  EXPECT_GE(solvers, 2u);
  EXPECT_FALSE(batch_optimum(recording.log, EstimatorRegistry()));
}

TEST(RecordingFacts, AStudyKnowsMoreThanARun) {
  const Recording recording = test::square(false);
  const RecordingFacts of_run = run_facts(recording);
  EXPECT_FALSE(of_run.chi2_optimum);
  EXPECT_FALSE(of_run.true_overlaps);
  const RecordingFacts of_study = study_facts(recording, builtin_estimators());
  EXPECT_EQ(of_study.log_hash, hash_text(to_g2o(recording.log)));
  for (const char* const type : {"ekf", "sparse_gauss_newton"}) {
    EXPECT_FALSE(evaluated(recording, type, nullptr).metric("chi2_optimum"));
    const Result result = evaluated(recording, type, &of_study);
    EXPECT_NEAR(result.metric("chi2_optimum").value(), *of_study.chi2_optimum,
                1e-9 * *of_study.chi2_optimum);
    EXPECT_GE(result.metric("chi2_gap").value(), 0.0);
  }
}

// Another minimum than that of the solves from dead reckoning: what is known of it is too high.
TEST(RecordingFacts, AnEstimateBelowTheKnownOptimumLeadsToItsOwn) {
  const Recording recording = test::square(false);
  const auto optimum = batch_optimum(recording.log, builtin_estimators());
  ASSERT_TRUE(optimum);
  RecordingFacts facts = run_facts(recording);
  facts.chi2_optimum = 1e9;
  const Result result = evaluated(recording, "ekf", &facts);
  EXPECT_NEAR(result.metric("chi2_optimum").value(), optimum->chi2, 1e-9 * optimum->chi2);
}

}  // namespace
}  // namespace fathom
