#pragma once

#include <vector>

#include "fathom/measurements/relative_pose.hpp"

namespace fathom::command {

/// What a program is given: a pose graph whose node 0 is fixed.
struct ProgramGraph {
  std::vector<Pose> poses;  ///< of every node: where the program is to begin; world frame
  /// Steps and loops in the order in which they came, without the holes that a batch solve ignores.
  std::vector<RelativePose> edges;
};

}  // namespace fathom::command
