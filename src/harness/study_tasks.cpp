#include "study_tasks.hpp"

#include <algorithm>
#include <map>
#include <numeric>

#include "fathom/core/random.hpp"
#include "fathom/harness/study_run.hpp"
#include "fathom/harness/survey.hpp"
#include "fathom/results/run_index.hpp"

namespace fathom {
namespace {

// What is missing of one trial.
Task task_of(const Study& study, const RunIndex* there, std::size_t cell, const TrialKey& trial) {
  Task task{cell, trial.survey, trial.trial, {}, false};
  const auto is_there = [there](const RunKey& run) { return there != nullptr && there->has(run); };
  task.baseline = !is_there(task.run_of(kDeadReckoning));
  for (std::size_t e = 0; e < study.description.estimators.size(); ++e) {
    if (!is_there(task.run_of(study.description.estimators[e].name))) {
      task.estimators.push_back(e);
    }
  }
  // Whoever runs first finds caches cold. Of two trials that follow each other one has the order of
  // the other from the end: each estimator runs before each other one as often as after it.
  const std::uint64_t number = trial.survey + trial.trial;
  RandomStream order(study.noise_seeds[cell], "order of runs", number / 2);
  for (std::size_t i = task.estimators.size(); i > 1; --i) {
    std::swap(task.estimators[i - 1], task.estimators[order.index(i)]);
  }
  if (number % 2 == 1) std::ranges::reverse(task.estimators);
  return task;
}

// Those over the same pictures one after the other.
std::vector<std::size_t> cells_in_order(const Study& study, const StudyDataSets& data_sets) {
  std::vector<std::size_t> cells(study.cells.size());
  std::iota(cells.begin(), cells.end(), std::size_t{0});
  std::ranges::stable_sort(cells, {},
                           [&](std::size_t cell) { return data_sets.shared_with(cell); });
  return cells;
}

// Of a data set; of a graph its keyframes, of which it is said whether they are.
struct Size {
  std::size_t count = 1;
  bool is_graph = true;
};

Size size_of(const DataSet& data) {
  if (const FrameSource* frames = data.frames()) return {frames->size(), false};
  return {data.graph() != nullptr ? data.graph()->size() : 1, true};
}

// Of a trial, by cell.
std::vector<double> costs_of(const Study& study) {
  std::map<std::string, Size> sizes;
  std::vector<double> costs;
  for (const Configuration& cell : study.cells) {
    const auto [size, is_new] = sizes.emplace(data_settings(cell), Size{});
    if (is_new) size->second = size_of(*open_data_set(cell));
    const int frames_apart =
        size->second.is_graph ? 1 : cell.front_end.keyframes.least_separation();
    const auto keyframes = static_cast<double>(size->second.count) / frames_apart;
    costs.push_back(std::max(keyframes * keyframes, 1.0));
  }
  return costs;
}

// Cells in their own order.
ShardRange all_of(const Study& study) {
  ShardRange all{study.description.surveys, study.description.trials, {}, 0, trials_in_all(study)};
  all.places.resize(study.cells.size());
  std::iota(all.places.begin(), all.places.end(), std::size_t{0});
  return all;
}

}  // namespace

ShardTrials::ShardTrials(const Study& study, const StudyDataSets& data_sets, const Shard& shard)
    : range_(all_of(study)) {
  const std::vector<std::size_t> cells = cells_in_order(study, data_sets);
  for (std::size_t i = 0; i < cells.size(); ++i) range_.places[cells[i]] = i;
  if (shard.is_whole()) return;
  const std::vector<double> costs = costs_of(study);
  // The same operations in the same order on every machine.
  const double of_a_survey =
      std::accumulate(costs.begin(), costs.end(), 0.0) * static_cast<double>(range_.trials);
  const double share =
      of_a_survey * static_cast<double>(range_.surveys) / static_cast<double>(shard.of);
  range_.count = 0;
  double before = 0.0;
  std::size_t place = 0;
  for (std::size_t survey = 0; survey < range_.surveys; ++survey) {
    for (const std::size_t cell : cells) {
      for (std::size_t trial = 0; trial < range_.trials; ++trial, ++place, before += costs[cell]) {
        // A trial belongs where its middle lies.
        const auto index = static_cast<std::size_t>((before + 0.5 * costs[cell]) / share);
        if (std::min(index, shard.of - 1) + 1 != shard.index) continue;
        if (range_.count++ == 0) range_.first = place;
      }
    }
  }
}

ShardTrials::ShardTrials(const Study& study, std::size_t cell) : range_(all_of(study)) {
  range_.first = cell * range_.trials;
  range_.count = 1;
}

bool ShardTrials::has(std::size_t cell, const TrialKey& trial) const {
  return range_.has({cell, trial.survey, trial.trial, ""});
}

std::vector<Task> tasks_of(const Study& study, const RunIndex* there,
                           const StudyDataSets& data_sets, const ShardTrials& own,
                           std::size_t jobs) {
  const std::vector<std::size_t> cells = cells_in_order(study, data_sets);
  const std::size_t surveys = study.description.surveys;
  const std::size_t together = std::max<std::size_t>(jobs, 1);
  std::vector<Task> tasks;
  for (std::size_t first = 0; first < surveys; first += together) {
    for (const std::size_t cell : cells) {
      for (std::size_t trial = 0; trial < study.description.trials; ++trial) {
        for (std::size_t s = first; s < std::min(first + together, surveys); ++s) {
          if (!own.has(cell, {s, trial})) continue;
          Task task = task_of(study, there, cell, {s, trial});
          if (task.baseline || !task.estimators.empty()) tasks.push_back(std::move(task));
        }
      }
    }
  }
  return tasks;
}

StudyWork work_of(const Study& study, const StudyDataSets& data_sets,
                  const std::vector<Task>& tasks, bool with_runs) {
  StudyWork work;
  for (const Task& task : tasks) {
    const Configuration& configuration = study.cells[task.cell];
    if (!find_data_set(configuration.dataset.type).is_graph) {
      const bool is_own =
          configuration.study.association == Association::own && !task.estimators.empty();
      work.front_ends[data_sets.shared(task.cell, task.survey)] +=
          is_own ? task.estimators.size() : 1;
    }
    if (!with_runs) continue;
    for (const std::size_t e : task.estimators) ++work.runs[e];
  }
  return work;
}

std::size_t runs_in(const std::vector<Task>& tasks) {
  std::size_t runs = 0;
  for (const Task& task : tasks) runs += task.estimators.size();
  return runs;
}

}  // namespace fathom
