#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "fathom/configuration/study.hpp"
#include "fathom/results/result_store.hpp"
#include "study_data_sets.hpp"

namespace fathom {

/// One trial of one cell's survey, with the runs of it that are still to be done.
struct Task {
  std::size_t cell = 0;
  std::size_t survey = 0;
  std::size_t trial = 0;
  std::vector<std::size_t> estimators;
  bool baseline = false;

  RunKey run_of(const std::string& estimator) const { return {cell, survey, trial, estimator}; }
};

/// What of a study is not in its store. As many surveys take turns as there are jobs, since trials
/// of one survey wait for the same pictures and registrations; cells over the same pictures come
/// one after the other, so that few surveys are open at a time.
std::vector<Task> tasks_of(const Study& study, const ResultStore& store,
                           const StudyDataSets& data_sets, std::size_t jobs);

/// Of all cells and surveys, done or not.
std::size_t trials_in_all(const Study& study);

}  // namespace fathom
