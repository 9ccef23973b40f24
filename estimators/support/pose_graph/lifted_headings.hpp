#pragma once

#include <span>
#include <vector>

#include "estimators/support/pose_graph/edge.hpp"
#include "estimators/support/sparse/block_cholesky.hpp"

namespace fathom::pose_graph {

/// The numbers of `lifted_headings`, found on M3500a to c: they decide how fast it ends.
struct LiftedTuning {
  int max_steps = 50;
  /// It has ended when a step lowers the cost by a smaller share: only angles are read from it.
  double tolerance = 1e-5;
  /// Standard deviation of what starts in the second component; on a unit vector.
  double lift_noise = 0.3;
  /// Levenberg-Marquardt damping after a step that failed, and where it gives up.
  double first_damping = 1e-4;
  double largest_damping = 1e8;
};

/// Headings without a start: minimise Σ w |Y_k − e^{iδ} Y_i|² over unit vectors Y ∈ C². One
/// complex dimension more than headings need, so that a loop wound the wrong way by 2π, which is a
/// local minimum among headings, can be unwound through it: the second step of a Riemannian
/// staircase on the semidefinite relaxation, which is tight for the noise of useful measurements
/// (Rosen, Carlone, Bandeira and Leonard 2019, SE-Sync; Boumal, Voroninski and Bandeira 2016).
/// The headings are the angles along the direction in C² that most of Y lies in.
///
/// Starts at `theta`, each keyframe's second component a deterministic share of noise.
std::vector<double> lifted_headings(const sparse::Symbolic& symbolic, std::span<const Edge> edges,
                                    std::span<const double> theta, const LiftedTuning& tuning = {});

}  // namespace fathom::pose_graph
