#pragma once

#include <string>
#include <vector>

#include "fathom/core/text.hpp"
#include "fathom/measurements/relative_pose.hpp"

namespace fathom::command {

/// What a program is given: a pose graph whose node 0 is fixed.
struct ProgramGraph {
  std::vector<Pose> poses;  ///< of every node: where the program is to begin; world frame
  /// Steps and loops in the order in which they came, without the holes that a batch solve ignores.
  std::vector<RelativePose> edges;
};

/// " x y θ", to the last bit.
inline std::string text_of(const Pose& pose) {
  return ' ' + exact(pose.x) + ' ' + exact(pose.y) + ' ' + exact(pose.theta);
}

/// " from to x y θ Ω11 Ω12 Ω13 Ω22 Ω23 Ω33".
inline std::string text_of(const RelativePose& z) {
  std::string text = ' ' + std::to_string(z.from) + ' ' + std::to_string(z.to) + text_of(z.motion);
  for (int row = 0; row < 3; ++row) {
    for (int column = row; column < 3; ++column) text += ' ' + exact(z.information(row, column));
  }
  return text;
}

}  // namespace fathom::command
