#include "study_tasks.hpp"

#include <algorithm>
#include <numeric>

#include "fathom/results/run_index.hpp"

namespace fathom {
namespace {

// What is missing of one trial.
Task task_of(const Study& study, const RunIndex& there, std::size_t cell, const TrialKey& trial) {
  Task task{cell, trial.survey, trial.trial, {}, false};
  task.baseline = !there.has(task.run_of(kDeadReckoning));
  for (std::size_t e = 0; e < study.description.estimators.size(); ++e) {
    if (!there.has(task.run_of(study.description.estimators[e].name))) {
      task.estimators.push_back(e);
    }
  }
  return task;
}

}  // namespace

std::vector<Task> tasks_of(const Study& study, const ResultStore& store,
                           const StudyDataSets& data_sets, std::size_t jobs) {
  const RunIndex there(store);
  std::vector<std::size_t> cells(study.cells.size());
  std::iota(cells.begin(), cells.end(), std::size_t{0});
  std::ranges::stable_sort(cells, {},
                           [&](std::size_t cell) { return data_sets.shared_with(cell); });
  const std::size_t surveys = study.description.surveys;
  const std::size_t together = std::max<std::size_t>(jobs, 1);
  std::vector<Task> tasks;
  for (std::size_t first = 0; first < surveys; first += together) {
    for (const std::size_t cell : cells) {
      for (std::size_t trial = 0; trial < study.description.trials; ++trial) {
        for (std::size_t s = first; s < std::min(first + together, surveys); ++s) {
          Task task = task_of(study, there, cell, {s, trial});
          if (task.baseline || !task.estimators.empty()) tasks.push_back(std::move(task));
        }
      }
    }
  }
  return tasks;
}

std::size_t trials_in_all(const Study& study) {
  return study.cells.size() * study.description.surveys * study.description.trials;
}

}  // namespace fathom
