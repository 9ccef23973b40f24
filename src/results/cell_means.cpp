#include "cell_means.hpp"

#include <algorithm>
#include <functional>
#include <numeric>
#include <set>

#include "fathom/core/random.hpp"
#include "fathom/evaluation/statistics.hpp"

namespace fathom {
namespace {

using Cells = std::vector<std::vector<double>>;

double mean_of(const std::vector<double>& values) {
  // Where all are equal a sum would round.
  if (std::adjacent_find(values.begin(), values.end(), std::not_equal_to<>()) == values.end()) {
    return values.front();
  }
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double resampled_mean(const std::vector<double>& deviations, RandomStream& random) {
  double sum = 0.0;
  for (std::size_t i = 0; i < deviations.size(); ++i) {
    sum += deviations[random.index(deviations.size())];
  }
  return sum / static_cast<double>(deviations.size());
}

// Deviations from each cell's mean, so that equal values leave an interval of no width.
Interval stratified_interval(const Cells& cells, double estimate) {
  Cells deviations = cells;
  for (std::vector<double>& cell : deviations) {
    const double mean = mean_of(cell);
    for (double& value : cell) value -= mean;
  }
  const double count = static_cast<double>(cells.size());
  std::vector<double> jackknife;
  for (const std::vector<double>& cell : deviations) {
    const double others = static_cast<double>(cell.size() - 1);
    for (const double deviation : cell) {
      jackknife.push_back(estimate - deviation / (others * count));
    }
  }
  const BootstrapOptions options;
  RandomStream random(options.seed, "bootstrap over cells");
  std::vector<double> replicates(options.resamples, estimate);
  for (double& replicate : replicates) {
    for (const std::vector<double>& cell : deviations) {
      replicate += resampled_mean(cell, random) / count;
    }
  }
  return bca_interval(estimate, replicates, jackknife, options.probability);
}

std::optional<Interval> interval_of_one_survey(const std::vector<ClusteredValues>& cells,
                                               double estimate) {
  Cells trials;
  for (const ClusteredValues& cell : cells) {
    trials.push_back(cell.begin()->second);
    if (trials.back().size() < 2) return std::nullopt;
  }
  return stratified_interval(trials, estimate);
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
    result.interval = interval_of_one_survey(cells, result.mean);
  }
  return result;
}

double decisive_end(const Requirement& requirement, const TrialMean& value) {
  if (!value.interval) return value.mean;
  return requirement.is_upper_bound() ? value.interval->high : value.interval->low;
}

}  // namespace fathom
