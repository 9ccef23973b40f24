#pragma once

#include <map>
#include <string>
#include <vector>

#include "fathom/results/result_store.hpp"

namespace fathom {

/// An index of the runs of a study by estimator, cell, survey and trial: which are stored, which
/// missing. Every run of a store has the content that was stored (ResultStore checks it).
class RunIndex {
 public:
  using Trials = std::map<TrialKey, const RunRecord*>;

  explicit RunIndex(const ResultStore& store);
  RunIndex(const RunIndex&) = delete;
  RunIndex& operator=(const RunIndex&) = delete;

  const StudyDescription& study() const { return study_; }
  /// In the order of cell, survey, trial and estimator; dead reckoning's with the hash of a log of
  /// its trial.
  const std::vector<RunRecord>& runs() const { return runs_; }
  /// Whether a run is there, so that it need not be made again; it may have failed.
  bool has(const RunKey& key) const;
  /// All runs of an estimator in a cell, failed ones too.
  const Trials& of(const std::string& estimator, std::size_t cell) const;
  /// The trials of a cell that every estimator of the study has a run of.
  std::vector<TrialKey> common_trials(std::size_t cell) const;
  /// Names of all metrics that any run has, in order.
  std::vector<std::string> metrics() const;
  /// The most runs that were at work at the same time, over the cells.
  int most_jobs(const std::vector<std::size_t>& cells) const;
  /// The kinds of processor that estimators ran on, and how many runs each has.
  const std::map<std::string, std::size_t>& machines() const { return machines_; }
  /// The kind that has most runs, of several the first by name: figures of cost are over its runs
  /// alone, as those of different processors are no one quantity.
  const std::string& cost_machine() const { return cost_machine_; }
  /// What there is and what is missing of these cells; empty where they are finished.
  std::string unfinished(const std::vector<std::size_t>& cells) const;

 private:
  StudyDescription study_;
  std::vector<RunRecord> runs_;
  std::map<std::string, std::map<std::size_t, Trials>> by_estimator_;
  std::map<std::string, std::size_t> machines_;
  std::string cost_machine_;
};

/// What trials a figure is over: "10 surveys × 10 trials"; where surveys have more or fewer trials
/// "10 surveys × 10 trials (97 of 100)".
std::string repeats_text(Repetition repetition, const std::vector<TrialKey>& trials);

/// Whether the estimate of a run cannot be used; false of dead reckoning. An outcome that is not
/// known is a failure.
bool is_failed(const RunRecord& run);

}  // namespace fathom
