#pragma once

#include <span>
#include <vector>

#include "estimators/sparse_gauss_newton/loop_graph.hpp"

namespace fathom::sparse_gauss_newton {

/// Of every loop: νᵀ S⁻¹ ν against what all other edges say, that is, by how much F would rise for
/// it (3 degrees of freedom); 0 of the other edges. To be compared with χ²₃ whatever the weight
/// that the loop has now, as that has no part in it.
///
/// With C = J Σ Jᵀ, the part of ν's covariance that the estimate has, R = W⁻¹ and the weight w,
///
///     A = R / w − C       ν₋ = (R / w) A⁻¹ ν       S₋ = R + C A⁻¹ R / w
///
/// and of a loop with weight 0 ν₋ = ν, S₋ = R + C. `equations` hold the same edges; they are given
/// these weights. `nodes` is their minimum.
///
/// Of a loop with semi-definite W all this is of the rows that it measures, and the result, of less
/// degrees of freedom, is scaled to what is as unlikely of 3.
std::vector<double> leave_one_out(NormalEquations& equations, const LoopGraph& graph,
                                  std::span<const double> weights, std::span<const Node> nodes);

}  // namespace fathom::sparse_gauss_newton
