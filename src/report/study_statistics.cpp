#include "fathom/report/study_statistics.hpp"

#include <algorithm>
#include <set>

#include "study_results.hpp"

namespace fathom {
namespace {

// Null where it has no run in that cell.
const EstimatorResults* runs_in_cell(const StudyResults& results, const std::string& estimator,
                                     std::size_t number) {
  const auto cell = std::ranges::find(results.cells, number, &CellResults::cell);
  if (cell == results.cells.end()) return nullptr;
  const auto one = std::ranges::find(cell->estimators, estimator, &EstimatorResults::name);
  return one == cell->estimators.end() ? nullptr : &*one;
}

}  // namespace

std::optional<Interval> study_interval(const ResultStore& store, const std::string& metric,
                                       const std::string& estimator, std::size_t cell) {
  const StudyResults results = study_results(store, MetricsOf::none);
  const EstimatorResults* const one = runs_in_cell(results, estimator, cell);
  if (one == nullptr) return std::nullopt;
  const std::set<TrialKey> trials = trials_with(*one, metric);
  if (trials.empty()) return std::nullopt;
  return summary_over(*one, metric, trials).interval;
}

std::optional<PairedDifference> study_difference(const ResultStore& store,
                                                 const std::string& metric, const std::string& one,
                                                 const std::string& other, std::size_t cell) {
  const StudyResults results = study_results(store, MetricsOf::none);
  const EstimatorResults* const ours = runs_in_cell(results, one, cell);
  const EstimatorResults* const theirs = runs_in_cell(results, other, cell);
  if (ours == nullptr || theirs == nullptr) return std::nullopt;
  auto difference = difference_between(*ours, *theirs, metric);
  // Of one draw the tables test nothing.
  if (difference && difference->count < 2) difference->signed_rank = {};
  return difference;
}

}  // namespace fathom
