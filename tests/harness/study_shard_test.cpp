// Shards of a study: every trial once, whatever their number, of like cost.

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "fathom/harness/manifest.hpp"
#include "fathom/harness/study_run.hpp"
#include "harness/small_study.hpp"
#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

using test::TemporaryFolder;

// Cells of different cost: the longest log has 25 times the keyframes of the shortest one.
constexpr const char* kLogs = R"(
dataset:
  type: simulated_log
  mission: {type: single_loop, loop_width_m: 2}
  loops: {max_distance_m: 2}
estimators: [{type: ekf}]
sweep:
  - {key: dataset.mission.loop_length_m, name: length, values: [4, 20, 100]}
trials: 5
)";

Study study_of_logs() {
  return configure_study(test::settings_of(kLogs), builtin_estimators());
}

std::set<RunKey> runs_of_shard(const Study& study, const Shard& shard) {
  const TemporaryFolder folder;
  ResultStore store = ResultStore::write(folder.path(), study.description, "{}");
  StudyRunOptions options;
  options.shard = shard;
  const StudyRun done = run_study(study, builtin_estimators(), store, options);
  EXPECT_TRUE(done.is_finished);
  // What its manifest says of it.
  const auto plan =
      shard_plan(session_json(plan_of(study, shard, "fathom compare s.yaml"), 1)).value();
  EXPECT_EQ(plan.command_line, "fathom compare s.yaml");
  std::set<RunKey> keys;
  std::size_t estimators = 0;
  for (const RunRecord& run : store.runs()) {
    keys.insert(run.key);
    EXPECT_TRUE(plan.range.has(run.key)) << text_of(shard);
    if (run.key.estimator != kDeadReckoning) ++estimators;
  }
  EXPECT_EQ(estimators, plan.runs);
  EXPECT_EQ(plan.range.count, plan.runs);  // there is one estimator
  // The example is that of the first trial of all, which one shard has.
  EXPECT_EQ(!done.example.empty(), keys.contains({0, 0, 0, "ekf"}));
  return keys;
}

TEST(StudyShard, HaveEveryRunOnceWhateverTheirNumber) {
  const Study whole = study_of_logs();
  const std::set<RunKey> all = runs_of_shard(whole, {});
  EXPECT_EQ(all.size(), 2u * 3u * 5u);
  for (const std::size_t of : {1u, 2u, 7u, 64u}) {
    std::set<RunKey> together;
    std::size_t sum = 0;
    for (std::size_t index = 1; index <= of; ++index) {
      const std::set<RunKey> own = runs_of_shard(whole, {index, of});
      sum += own.size();
      together.insert(own.begin(), own.end());
    }
    EXPECT_EQ(sum, all.size()) << of;
    EXPECT_EQ(together, all) << of;
  }
}

TEST(StudyShard, AreOfLikeCost) {
  Study many = study_of_logs();
  many.description.trials = 300;
  // Trials of the dear cell and of the cheap ones: of two shards one has few of the former. Each
  // has its half of the cost, to within one trial of the dearest.
  std::vector<double> costs;
  for (const std::size_t index : {1u, 2u, 3u}) {
    costs.push_back(static_cast<double>(plan_of(many, {index, 3}, "").runs));
  }
  EXPECT_EQ(costs[0] + costs[1] + costs[2], 900.0);
  // The order is cell by cell: 300 of the cheap, 300 of the middle, 300 of the dear. These have
  // more than nine tenths of the cost, so that each shard has about 100 of them, and the first the
  // rest.
  EXPECT_GT(costs[0], 600.0);
  EXPECT_NEAR(costs[1], costs[2], 1.0);
  EXPECT_NEAR(costs[1], 105.0, 12.0);
}

TEST(StudyShard, AreTheSameWhateverIsThereAlready) {
  const Study whole = study_of_logs();
  const TemporaryFolder folder;
  ResultStore store = ResultStore::write(folder.path(), whole.description, "{}");
  StudyRunOptions options;
  options.shard = {2, 3};
  ASSERT_TRUE(run_study(whole, builtin_estimators(), store, options).is_finished);
  const std::size_t own = store.runs().size();
  ASSERT_TRUE(run_study(whole, builtin_estimators(), store, options).is_finished);
  EXPECT_EQ(store.runs().size(), own);
}

TEST(StudyShard, ASampleIsOneTrialOfItsCell) {
  const Study whole = study_of_logs();
  const TemporaryFolder folder;
  ResultStore store = ResultStore::write(folder.path(), whole.description, "{}");
  StudyRunOptions options;
  options.sample = 1;
  ASSERT_TRUE(run_study(whole, builtin_estimators(), store, options).is_finished);
  const auto runs = store.runs();
  ASSERT_EQ(runs.size(), 2u);
  EXPECT_EQ(runs[1].key, (RunKey{1, 0, 0, "ekf"}));
}

}  // namespace
}  // namespace fathom
