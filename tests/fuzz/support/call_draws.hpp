#pragma once

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "fathom/estimation/registry.hpp"
#include "support/fuzz.hpp"

/// What estimators may be given, drawn from an input.
namespace fathom::fuzz {

inline Pose drawn_pose(Draws& draws) {
  return {draws.between(-10.0, 10.0), draws.between(-10.0, 10.0), draws.between(-3.2, 3.2)};
}

/// A full covariance with standard deviations from 0.01 to 1 and correlations of both signs.
inline Eigen::Matrix3d drawn_covariance(Draws& draws) {
  Eigen::Matrix3d L = Eigen::Matrix3d::Zero();
  for (int row = 0; row < 3; ++row) {
    L(row, row) = std::pow(10.0, draws.between(-2.0, 0.0));
    for (int column = 0; column < row; ++column) {
      L(row, column) = L(row, row) * draws.between(-1.0, 1.0);
    }
  }
  return L * L.transpose();
}

inline RelativePose drawn_motion(Draws& draws, std::size_t from, std::size_t to) {
  const Pose motion = drawn_pose(draws);
  return RelativePose::from_covariance(from, to, motion, drawn_covariance(draws));
}

inline AbsolutePose drawn_absolute(Draws& draws, std::size_t keyframe) {
  const Pose pose = drawn_pose(draws);
  const Eigen::Matrix3d C = drawn_covariance(draws);
  const std::size_t kind = draws.below(3);
  if (kind == 0) return AbsolutePose::heading(keyframe, pose.theta, std::sqrt(C(2, 2)));
  if (kind == 1) return AbsolutePose::position(keyframe, pose.position(), C.topLeftCorner<2, 2>());
  return AbsolutePose::from_covariance(keyframe, pose, C);
}

inline std::vector<std::string> values_of(const OptionDescription& option) {
  if (option.key.ends_with("gate_probability")) return {"off", "0.5", "0.99"};
  if (option.key == "max_iterations") return {"1", "3", "20"};
  if (option.type == "boolean") return {"true", "false"};
  std::vector<std::string> choices;
  if (option.range.find(" | ") == std::string::npos) return choices;
  std::istringstream words(option.range);
  for (std::string word; words >> word;) {
    if (word != "|") choices.push_back(word);
  }
  return choices;
}

/// Some options with values of theirs.
inline EstimatorValues drawn_values(Draws& draws, const EstimatorEntry& entry) {
  EstimatorValues values;
  for (std::size_t left = draws.below(4); left > 0; --left) {
    const OptionDescription& option = entry.options[draws.below(entry.options.size())];
    const std::vector<std::string> choices = values_of(option);
    const std::size_t chosen = draws.byte();
    if (choices.empty()) continue;
    values[option.key] = OptionValue::scalar(choices[chosen % choices.size()]);
  }
  return values;
}

/// Fixed or uncertain; free only for a batch solve, whose first keyframe then has all measured.
inline StartPose drawn_start(Draws& draws, SolveMode mode) {
  StartPose start = drawn_pose(draws);
  const std::size_t kind = draws.below(3);
  if (kind == 1) start.covariance = drawn_covariance(draws);
  start.is_free = kind == 2 && mode == SolveMode::batch;
  return start;
}

}  // namespace fathom::fuzz
