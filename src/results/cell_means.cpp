#include "cell_means.hpp"

#include <set>

namespace fathom {
namespace {

double mean_of(const std::vector<double>& values) {
  return clustered_mean({{0, values}});
}

std::vector<std::vector<double>> trials_of(const std::vector<ClusteredValues>& cells) {
  std::vector<std::vector<double>> trials;
  trials.reserve(cells.size());
  for (const ClusteredValues& cell : cells) trials.push_back(cell.begin()->second);
  return trials;
}

}  // namespace

TrialMean mean_over_cells(const std::vector<ClusteredValues>& cells) {
  TrialMean result;
  std::set<std::size_t> surveys;
  std::vector<double> means;
  for (const ClusteredValues& cell : cells) {
    for (const auto& [survey, values] : cell) {
      result.count += values.size();
      surveys.insert(survey);
    }
    means.push_back(clustered_mean(cell));
  }
  result.mean = mean_of(means);
  if (cells.size() == 1) {
    result.interval = hierarchical_interval(cells.front());
  } else if (surveys.size() > 1) {
    result.interval = interval_over_cells(cells);
  } else {
    result.interval = stratified_interval(trials_of(cells));
  }
  return result;
}

double decisive_end(const Requirement& requirement, const TrialMean& value) {
  if (!value.interval) return value.mean;
  return requirement.is_upper_bound() ? value.interval->high : value.interval->low;
}

}  // namespace fathom
