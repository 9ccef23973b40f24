#pragma once

#include <optional>
#include <vector>

#include "estimators/support/pose_graph/chain_equations.hpp"
#include "estimators/support/pose_graph/normal_equations.hpp"
#include "fathom/estimation/estimator.hpp"

namespace fathom::pose_graph {

struct SolveLimits {
  int max_iterations = 100;
  double tolerance = 1e-8;

  bool operator==(const SolveLimits&) const = default;
};

/// The numbers of `minimise`, found on the graphs of docs/estimators/sparse_gauss_newton.md. They
/// decide how fast it gets to a minimum.
struct SolverTuning {
  /// Newton's steps are worth their exact Hessian, and safe, once Gauss-Newton promises to lower F
  /// by a smaller share; and by `after_indefinite` of it where that Hessian was not definite.
  double newton_below = 0.05;
  double after_indefinite = 1e-2;
  /// After a Newton step that promises to lower F by a smaller share, its factor serves on: chords
  /// (Ortega and Rheinboldt 1970), as long as each promises at most `chord_contraction` of what the
  /// one before did, until one promises `chord_share` of the tolerance. A chord does not square the
  /// error, so it has to promise less than a Newton step.
  double chord_below = 1e-3;
  double chord_contraction = 1e-2;
  double chord_share = 5e-2;
  /// A first step is left to conjugate gradients where a factorisation costs as much as so many of
  /// their iterations (NormalEquations::solve_near), from some 200 000 keyframes on.
  int least_near_iterations = 5;
  /// Levenberg-Marquardt damping after a step that failed; then more after each that
  /// fails and less after each that does not (Marquardt 1963). Below the least there is none;
  /// beyond the largest no step is left in 16 digits.
  double first_damping = 1e-5;
  double least_damping = 1e-9;
  double largest_damping = 1e12;
  double damping_increase = 10.0;
  double damping_decrease = 0.1;
  /// By so much, as a share and in squared sigmas, rounding may make F rise: where all measurements
  /// agree, F itself is rounding.
  double rounding_share = 1e-11;
  double rounding_chi2 = 1e-12;
  /// A rise of F by more, as a share and in squared sigmas, over a step that is nearly nothing is a
  /// jump.
  double jump_share = 1e-6;
  double jump_chi2 = 1e-6;
  /// A step that promises less, in squared sigmas, is one of rounding.
  double least_promise_chi2 = 1e-20;
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
/// step promises to lower F, or moves the poses, by less than the tolerance, as a share: one with
/// the exact Hessian of the estimate, or of one just before it (SolverTuning::chord_share). Where F
/// is higher by more than the tolerance after that step, the estimate before it is kept.
/// Where F jumps, as a heading residual passes ±π, and is least beside the jump, no step lowers it:
/// iteration_limit.
/// `first`: the Hessian of the first step, exact where the start is known to be near a minimum.
SolveResult minimise(NormalEquations& equations, std::vector<Node>& nodes,
                     const SolveLimits& limits, const SolverTuning& tuning = {},
                     Hessian first = Hessian::gauss_newton);

SolveResult minimise(ChainEquations& equations, std::vector<Node>& nodes, const SolveLimits& limits,
                     Hessian first);

}  // namespace fathom::pose_graph
