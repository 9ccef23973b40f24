#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "fathom/configuration/study.hpp"
#include "fathom/results/result_store.hpp"
#include "fathom/results/run_index.hpp"
#include "fathom/results/shard.hpp"
#include "study_data_sets.hpp"

namespace fathom {

/// One trial of one cell's survey, with the runs of it that are still to be done.
struct Task {
  std::size_t cell = 0;
  std::size_t survey = 0;
  std::size_t trial = 0;
  std::vector<std::size_t> estimators;
  bool baseline = false;

  /// The trial whose runs `compare` writes.
  bool is_example() const { return cell == 0 && survey == 0 && trial == 0; }
  RunKey run_of(const std::string& estimator) const { return {cell, survey, trial, estimator}; }
};

/// Which trials of a study are a shard's. The trials stand in one order, survey by survey and in it
/// the cells over the same pictures one after the other, and are cut where their estimated cost is
/// divided evenly: the shards of one division have every trial once, whatever machine asks. The
/// cost of a trial is taken to grow with the square of its keyframes.
class ShardTrials {
 public:
  ShardTrials(const Study& study, const StudyDataSets& data_sets, const Shard& shard);

  /// The first trial of the first survey of a cell alone.
  ShardTrials(const Study& study, std::size_t cell);

  bool has(std::size_t cell, const TrialKey& trial) const;
  std::size_t count() const { return range_.count; }
  const ShardRange& range() const { return range_; }

 private:
  ShardRange range_;
};

/// What of a shard is not in its store; all of it where there is none. As many surveys take turns
/// as there are jobs, since trials of one survey wait for the same pictures and registrations;
/// cells over the same pictures come one after the other, so that few surveys are open at a time.
std::vector<Task> tasks_of(const Study& study, const RunIndex* there,
                           const StudyDataSets& data_sets, const ShardTrials& own,
                           std::size_t jobs);

/// What they come to, with the runs or without.
StudyWork work_of(const Study& study, const StudyDataSets& data_sets,
                  const std::vector<Task>& tasks, bool with_runs);

/// Runs of estimators in all of them.
std::size_t runs_in(const std::vector<Task>& tasks);

}  // namespace fathom
