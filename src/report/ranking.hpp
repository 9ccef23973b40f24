#pragma once

#include <optional>
#include <string>
#include <vector>

#include "study_results.hpp"

namespace fathom {

/// One estimator beside the best one of a cell.
struct RankedEstimator {
  std::string name;
  MetricSummary summary;
  /// It minus the best, with an interval that holds together with those of the others
  /// (`Ranking::level`); nothing of the best itself, and where the two have no trial in common.
  std::optional<PairedDifference> difference;
  std::optional<double> holm_p;  ///< adjusted over the others of this ranking

  /// Whether the interval excludes 0. False of the best itself and without an interval.
  bool is_told_apart() const {
    return difference && difference->interval && !difference->interval->contains(0.0);
  }
};

/// The estimators of a cell by their means of one metric, the best first.
struct Ranking {
  std::string metric;
  std::vector<RankedEstimator> estimators;  ///< one or more
  double level = 0.95;  ///< of each interval: 1 − 0.05 / number of differences

  const RankedEstimator& best() const { return estimators.front(); }
  const RankedEstimator* find(const std::string& estimator) const;
  std::vector<const RankedEstimator*> told_apart() const;
};

/// Estimators that failed no run and have the metric; of `names` alone, where there are any. Dead
/// reckoning is none. Nothing where none is left and of a metric that does not say which of its
/// values is better. The best is the one with the best mean, of equal ones the first of the study.
///
/// The intervals are Bonferroni's: each of m has the level 1 − 0.05 / m, so that they hold together
/// with 95 %. The best was chosen by the same runs, which no interval knows of: a difference that
/// barely excludes 0 is weak evidence.
std::optional<Ranking> ranking(const CellResults& cell, const std::string& metric,
                               const std::vector<std::string>& names = {});

/// By which estimators are ranked: the first of the study's metrics that is no cost, says which of
/// its values is better, and that a cell has. Nothing without one.
std::optional<std::string> ranking_metric(const StudyResults& results);

}  // namespace fathom
