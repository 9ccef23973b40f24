#include "cell_means.hpp"

#include <algorithm>
#include <numeric>

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

}  // namespace

TrialMean mean_over_cells(const Cells& cells) {
  TrialMean result;
  bool has_interval = true;
  std::vector<double> means;
  for (const std::vector<double>& cell : cells) {
    result.count += cell.size();
    means.push_back(mean_of(cell));
    has_interval = has_interval && cell.size() > 1;
  }
  result.mean = mean_of(means);
  if (!has_interval) return result;
  result.interval = cells.size() == 1 ? bootstrap_interval(cells.front())
                                      : stratified_interval(cells, result.mean);
  return result;
}

double decisive_end(const Requirement& requirement, const TrialMean& value) {
  if (!value.interval) return value.mean;
  return requirement.is_upper_bound() ? value.interval->high : value.interval->low;
}

}  // namespace fathom
