#pragma once

#include <vector>

#include "estimators/incremental_smoother/problem.hpp"

namespace fathom::incremental_smoother {

/// F and the gradient of ½F, kept edge by edge; says what loops weigh.
class Gradient {
 public:
  /// The problem must outlive it.
  explicit Gradient(Problem& problem) : problem_(problem), by_keyframe_(1) {}

  void add_keyframe() { by_keyframe_.emplace_back(); }
  /// The newest edge of the problem.
  void add_edge();
  /// An edge again, at the present estimate.
  void evaluate(int edge);
  /// All edges again, as many as there are now.
  void evaluate_all();

  double cost() const { return cost_; }
  /// Each along the keyframe's own axes.
  const std::vector<Vec3>& by_keyframe() const { return by_keyframe_; }

 private:
  Problem& problem_;
  std::vector<EdgeGradient> terms_;  ///< by edge
  std::vector<Vec3> by_keyframe_;
  double cost_ = 0.0;
};

}  // namespace fathom::incremental_smoother
