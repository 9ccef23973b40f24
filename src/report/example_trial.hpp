#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "fathom/geometry/pose.hpp"
#include "fathom/measurements/decision.hpp"
#include "fathom/report/trajectory_plot.hpp"
#include "stored_absolute.hpp"
#include "study_results.hpp"

namespace fathom {

/// The 2σ ellipse of the position at a keyframe: centre + axes · (cos t, sin t), in metres.
struct ExampleEllipse {
  std::size_t keyframe = 0;
  Eigen::Vector2d centre;
  Eigen::Matrix2d axes;
};

/// One estimator, or dead reckoning, on the trial that is drawn.
struct DrawnRun {
  std::string estimator;
  bool is_done = false;
  std::vector<Pose> poses;               ///< aligned as the errors are; headings are not stored
  std::vector<ExampleEllipse> ellipses;  ///< of some 25 keyframes; dead reckoning has none drawn
  std::vector<LoopDecision> loops;       ///< in the order of the store
  std::vector<StoredAbsolute> absolute;

  /// Whether both ends of a loop are among the poses, and can be drawn.
  bool has_ends(const LoopDecision& loop) const;
  /// What the map draws, without a style and loops.
  PlotSeries series() const;
};

/// The lowest trial of a cell's lowest survey: what maps of the page and of the figures show.
struct ExampleTrial {
  TrialKey trial;
  std::vector<Pose> truth;     ///< empty where it is unknown
  std::vector<DrawnRun> runs;  ///< of the estimators that ran it, in the order of the cell
};

/// By cell, in the order of `results`.
std::vector<ExampleTrial> example_trials(const ResultStore& store, const StudyResults& results);

}  // namespace fathom
