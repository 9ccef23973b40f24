#pragma once

#include <span>
#include <vector>

#include "estimators/support/pose_graph/edge.hpp"
#include "estimators/support/sparse/block_cholesky.hpp"

namespace fathom::pose_graph {

/// Headings without a start: minimise Σ w |Y_k − e^{iδ} Y_i|² over unit vectors Y ∈ C². One
/// complex dimension more than headings need, so that a loop wound the wrong way by 2π, which is a
/// local minimum among headings, can be unwound through it: the second step of a Riemannian
/// staircase on the semidefinite relaxation, which is tight for the noise of useful measurements
/// (Rosen, Carlone, Bandeira and Leonard 2019, SE-Sync; Boumal, Voroninski and Bandeira 2016).
/// The headings are the angles along the direction in C² that most of Y lies in.
///
/// Starts at `theta`, each keyframe's second component a deterministic share of noise.
std::vector<double> lifted_headings(const sparse::Symbolic& symbolic, std::span<const Edge> edges,
                                    std::span<const double> theta);

}  // namespace fathom::pose_graph
