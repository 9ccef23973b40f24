#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "example_trial.hpp"
#include "keyframe_series.hpp"

namespace fathom {

// What the charts show, in the units of their metrics: the figures for print and the page draw the
// same rows.

/// What charts are made from.
struct ChartInput {
  const StudyResults& results;
  const std::vector<std::vector<EstimatorSeries>>& series;  ///< by cell and estimator
  const std::vector<ExampleTrial>& examples;                ///< by cell
};

/// A value as charts tell it from others: solvers that find the same optimum differ in the tenth
/// digit, and none of them is better for that.
double six_digits(double value);

/// A mean with the band of two standard deviations about it, which ends at zero where the mean is
/// not below it: an error is no less.
struct BandedMean {
  double mean = 0.0;
  double low = 0.0;
  double high = 0.0;
};

/// Without a deviation the band is the mean itself.
BandedMean banded(double mean, const std::optional<double>& standard_deviation);

/// Where the labels of a swept axis lie: numbers where they are; nothing where a label is none.
std::optional<std::vector<double>> numeric_positions(const std::vector<std::string>& labels);

/// An estimator's means of an accuracy metric and of a cost; of those that are compared over the
/// trials that they are ranked by.
struct CostPoint {
  std::string estimator;
  double cost = 0.0;
  double error = 0.0;
  Interval costs;  ///< 95 %, or the mean alone; from the mean on where it reaches zero
  Interval errors;
  bool is_compared = true;  ///< it is ranked by both
};

/// Those of a cell that have both, and a cost above zero, which a logarithmic axis needs.
std::vector<CostPoint> cost_points(const CellResults& cell, const std::string& accuracy,
                                   const std::string& cost);

/// The points that are compared and that none of these beats: as good in both to six digits, and
/// better in one. By rising cost; empty for a metric of which neither direction is better.
std::vector<CostPoint> pareto_front(const std::vector<CostPoint>& points, Better better);

/// By estimator that is ranked: how many have a mean that is better to six digits.
std::map<std::string, std::size_t> ranks_of(const CellResults& cell, const std::string& metric);

/// NEES / 3 by keyframe (x), those above zero, and the χ² interval of its mean.
struct NeesChart {
  using Points = std::vector<Eigen::Vector2d>;
  std::vector<std::pair<std::string, Points>> lines;  ///< by estimator that has any
  Points low;  ///< of the 95 % interval, of the estimator with the most independent draws
  Points high;
  std::size_t draws = 0;      ///< of that estimator at one keyframe, at most
  std::size_t keyframes = 0;  ///< that it has
};

NeesChart nees_chart(const CellResults& cell, const std::vector<EstimatorSeries>& series);

/// Trials by how their runs ended, in the order of `Outcome`, then what another version called
/// them; last "not run".
std::vector<std::pair<std::string, std::size_t>> outcome_counts(const EstimatorResults& estimator,
                                                                const StudyDescription& study);

}  // namespace fathom
