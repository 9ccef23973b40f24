#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "study_results.hpp"

namespace fathom {

/// Two axes of a study, across and up, at one place of every other axis.
struct RegimeMap {
  std::size_t across = 0;
  std::size_t up = 0;
  std::string others;  ///< " loops 4", empty without other axes
  /// By place across, then up; null where a cell has no runs. They belong to the results.
  std::vector<std::vector<const CellResults*>> cells;
};

/// One for each place on the axes after the first two that have several values; none with fewer.
std::vector<RegimeMap> regime_maps(const StudyResults& results);

/// What an estimator is called as good as the best one by: a mean that is worse by this share.
inline constexpr double kAsGoodAsBest = 0.05;

/// A mean over the best estimator's of the cell: 1 is the best, 2 twice as large. Of metrics of
/// which less is better, estimators that have failed no trial, and a best mean above zero.
std::optional<double> relative_to_best(const CellResults& cell, const EstimatorResults& estimator,
                                       const std::string& metric);

/// The estimator with the least mean cost of those as good as the best one; nothing where none
/// has done all its trials, or the metric has no best.
std::optional<std::string> cheapest_of_the_best(const CellResults& cell, const std::string& metric,
                                                const std::string& cost);

}  // namespace fathom
