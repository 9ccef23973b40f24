#pragma once

#include <vector>

#include "fathom/evaluation/alignment.hpp"

namespace fathom {

/// The parameters of the metrics.
struct MetricOptions {
  Alignment alignment = Alignment::origin;  ///< of the absolute errors
  std::vector<double> rpe_keyframes{1};     ///< separations of relative errors, whole numbers
  std::vector<double> rpe_distances_m;      ///< and path lengths
  int anchors = 5;                          ///< keyframes held in turn (anchored_anees)
  /// Motions over each of these, and keyframes for each anchor, at most: it keeps the joint
  /// covariances, 3 columns a keyframe, small.
  int relative_pairs = 20;
  double held_out_loops = 0.1;    ///< share of the loops that a second run of a study is not given
  int held_out_pairs = 200;       ///< of them, those that held_out_nis is over, at most
  double recalled_overlap = 0.3;  ///< true overlap from which on loop_recall counts a pair
};

}  // namespace fathom
