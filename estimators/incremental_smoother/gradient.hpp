#pragma once

#include <vector>

#include "estimators/incremental_smoother/problem.hpp"

namespace fathom::incremental_smoother {

/// F and the gradient of ½F, kept edge by edge; says what loops weigh.
class Gradient {
 public:
  /// The problem must outlive it.
  explicit Gradient(Problem& problem) : problem_(problem), by_variable_{std::vector<Vec3>(1)} {}

  void add_keyframe() { by_variable_.poses.emplace_back(); }
  /// The newest edge of the problem.
  void add_edge();
  /// An edge again, at the present estimate.
  void evaluate(int edge);
  /// As if the edge were not there, until it is evaluated: before its errors become unknowns.
  void take_out(int edge);
  /// The prior of a picture's errors again.
  void evaluate_prior(int keyframe);
  /// All again, as many as there are now.
  void evaluate_all();

  double cost() const { return cost_; }
  /// Each keyframe's along its own axes.
  const ByVariable<Vec3>& by_variable() const { return by_variable_; }

 private:
  void replace(int edge, const EdgeGradient& next);
  void grow_errors();
  void add_errors(const Edge& edge, const EdgeGradient& t, double sign);

  Problem& problem_;
  std::vector<EdgeGradient> terms_;  ///< by edge
  std::vector<Vec3> priors_;         ///< by keyframe: n as it was evaluated last
  ByVariable<Vec3> by_variable_;
  double cost_ = 0.0;
};

}  // namespace fathom::incremental_smoother
