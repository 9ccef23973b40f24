#include "study_tasks.hpp"

#include <algorithm>
#include <numeric>

#include "fathom/results/run_index.hpp"

namespace fathom {
namespace {

void add_tasks(const Study& study, const RunIndex& there, std::size_t cell, std::size_t survey,
               std::vector<Task>& tasks) {
  for (std::size_t trial = 0; trial < study.description.trials; ++trial) {
    Task task{cell, survey, trial, {}, false};
    task.baseline = !there.has(task.run_of(kDeadReckoning));
    for (std::size_t e = 0; e < study.description.estimators.size(); ++e) {
      if (!there.has(task.run_of(study.description.estimators[e].name))) {
        task.estimators.push_back(e);
      }
    }
    if (task.baseline || !task.estimators.empty()) tasks.push_back(task);
  }
}

}  // namespace

std::vector<Task> tasks_of(const Study& study, const ResultStore& store,
                           const StudyDataSets& data_sets) {
  const RunIndex there(store);
  std::vector<std::size_t> cells(study.cells.size());
  std::iota(cells.begin(), cells.end(), std::size_t{0});
  std::ranges::stable_sort(cells, {},
                           [&](std::size_t cell) { return data_sets.shared_with(cell); });
  std::vector<Task> tasks;
  for (std::size_t survey = 0; survey < study.description.surveys; ++survey) {
    for (const std::size_t cell : cells) add_tasks(study, there, cell, survey, tasks);
  }
  return tasks;
}

std::size_t trials_in_all(const Study& study) {
  return study.cells.size() * study.description.surveys * study.description.trials;
}

}  // namespace fathom
