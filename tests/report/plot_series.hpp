#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "fathom/report/trajectory_plot.hpp"

namespace fathom::test {

/// The trajectory of the estimator at this place of a study, in its style.
inline PlotSeries series_of(std::size_t place, std::vector<Pose> poses) {
  PlotSeries series;
  series.name = "estimator " + std::to_string(place);
  series.style = estimator_style(place);
  series.poses = std::move(poses);
  return series;
}

}  // namespace fathom::test
