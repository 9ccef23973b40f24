#pragma once

#include <optional>
#include <vector>

#include "estimators/support/pose_graph/normal_equations.hpp"
#include "fathom/estimation/estimator.hpp"

namespace fathom::pose_graph {

struct SolveLimits {
  int max_iterations = 100;
  double tolerance = 1e-8;
};

struct SolveResult {
  Outcome outcome = Outcome::converged;
  int iterations = 0;
  double cost = 0.0;  ///< F at the estimate
  double gradient_norm = 0.0;
  /// Whether the exact Hessian is positive definite; absent where the solve did not get there.
  std::optional<bool> is_local_minimum;
};

/// Minimises F from `nodes` on, in place. Undamped steps as long as F falls, Gauss-Newton first,
/// Newton near the end; else Levenberg-Marquardt damping until it does. It has converged when a
/// step promises to lower F, or moves the poses, by less than the tolerance, as a share.
SolveResult minimise(NormalEquations& equations, std::vector<Node>& nodes,
                     const SolveLimits& limits);

}  // namespace fathom::pose_graph
