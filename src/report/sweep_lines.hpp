#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "study_figures.hpp"

namespace fathom {

using Points = std::vector<Eigen::Vector2d>;

/// One estimator along the sweep. NaN-free: a cell that lacks a value has no point.
struct SweepLine {
  std::string estimator;
  Points mean;
  Points low;
  Points high;
  Points empirical;
  Points estimated;
};

/// The points of a study along one of its axes.
struct Sweep {
  std::size_t axis = 0;
  std::vector<std::size_t> cells;  ///< places in the results
  std::vector<double> positions;
  bool is_numeric = false;  ///< else there is nothing between the positions
};

std::vector<SweepLine> sweep_lines(const ChartInput& input, const Sweep& sweep,
                                   const std::string& metric);

/// The cells that share their places on every other axis.
std::vector<Sweep> sweeps_along(std::size_t axis, const StudyResults& results);

/// Its place on the other axes, in words.
std::string name_of_others(const Sweep& sweep, const StudyResults& results);

}  // namespace fathom
