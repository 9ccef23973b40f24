#pragma once

#include <map>
#include <string>
#include <vector>

#include "fathom/results/result_store.hpp"

namespace fathom {

/// The runs of a study by estimator, cell and trial.
class StudyRuns {
 public:
  using Trials = std::map<std::size_t, const RunRecord*>;

  explicit StudyRuns(const ResultStore& store);

  const StudyDescription& study() const { return study_; }
  /// All runs of an estimator in a cell, failed ones too.
  const Trials& of(const std::string& estimator, std::size_t cell) const;
  /// The trials of a cell that every estimator of the study has a run of.
  std::vector<std::size_t> common_trials(std::size_t cell) const;
  /// Names of all metrics that any run has, in order.
  std::vector<std::string> metrics() const;
  /// The most runs that were at work at the same time, over the cells.
  int most_jobs(const std::vector<std::size_t>& cells) const;
  /// What there is and what is missing of these cells; empty where they are finished.
  std::string unfinished(const std::vector<std::size_t>& cells) const;

 private:
  StudyDescription study_;
  std::vector<RunRecord> runs_;
  std::map<std::string, std::map<std::size_t, Trials>> by_estimator_;
};

bool is_failed(const RunRecord& run);

}  // namespace fathom
