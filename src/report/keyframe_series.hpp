#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "study_results.hpp"

namespace fathom {

/// A quantity by keyframe over the trials of one estimator that were done. Entry i of every list is
/// of keyframe `keyframe[i]`; nothing where no trial has it.
struct KeyframeStatistics {
  std::vector<std::size_t> keyframe;
  std::vector<std::size_t> count;                  ///< trials with a position error there
  std::vector<std::optional<double>> mean_m;       ///< mean position error
  std::vector<std::optional<double>> sd_m;         ///< its standard deviation, n − 1
  std::vector<std::optional<double>> empirical_m;  ///< twice the root mean square position error
  std::vector<std::optional<double>> estimated_m;  ///< mean of 2·√(P_xx + P_yy): what it should be
  std::vector<std::size_t> nees_count;             ///< trials with a NEES there
  std::vector<std::size_t> nees_draws;             ///< of them independent draws
  std::vector<std::optional<double>> anees;        ///< mean pose NEES / 3
};

/// The cost of an update by the keyframe at which it was made, over the trials that were done.
struct UpdateCost {
  std::vector<std::size_t> keyframe;  ///< rising
  std::vector<std::size_t> count;
  std::vector<double> median_ms;
};

/// Mean over keyframes from 1 on and trials of 2·√(P_xx + P_yy), and twice the root mean square
/// position error over the same: equal for a consistent estimator.
struct SweepBounds {
  double empirical_m = 0.0;
  std::optional<double> estimated_m;
};

/// What is read from the series of all trials of an estimator on a cell.
struct EstimatorSeries {
  KeyframeStatistics keyframes;
  UpdateCost updates;
  std::optional<SweepBounds> bounds;
};

EstimatorSeries estimator_series(const ResultStore& store, const EstimatorResults& runs,
                                 Repetition repetition);

/// By cell and estimator, in the order of `results`.
std::vector<std::vector<EstimatorSeries>> study_series(const ResultStore& store,
                                                       const StudyResults& results);

/// Evenly spaced indices below `count`, the first and the last among them, about `most` at most.
std::vector<std::size_t> thinned(std::size_t count, std::size_t most);

/// The entries of a list at some indices; indices beyond its end are left out.
template <typename Value>
std::vector<Value> picked(const std::vector<Value>& values,
                          const std::vector<std::size_t>& places) {
  std::vector<Value> some;
  for (const std::size_t place : places) {
    if (place < values.size()) some.push_back(values[place]);
  }
  return some;
}

}  // namespace fathom
