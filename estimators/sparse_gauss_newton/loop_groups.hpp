#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "estimators/sparse_gauss_newton/loop_graph.hpp"

namespace fathom::sparse_gauss_newton {

/// Whether a loop is written from its earlier keyframe to its later one.
bool is_forward(const Edge& edge);

/// Loops (indices of edges) in groups: two are in one if their ends are within `reach`
/// keyframes of each other, whatever way round each is written, and `belong` says so, or a third is
/// in one with both. The largest group first.
std::vector<std::vector<std::size_t>> group_loops(
    std::span<const Edge> edges, std::vector<std::size_t> loops, int reach,
    const std::function<bool(const Edge&, const Edge&)>& belong);

/// By how much F would fall if a group of loops could be off by a common motion: a score test, 3
/// degrees of freedom, of what all other edges say against the group as a whole. Loops that support
/// each other may be wrong together; leaving out one of them would not show it.
///
/// The motion δ moves what the later ends p_k of the loops see about the first of them. With
/// T_k = [1 0 −(y_k − y₀); 0 1 x_k − x₀; 0 0 1] and M, m, T of an edge (EdgeTerms):
/// g = Σ T_kᵀ m, I = Σ T_kᵀ M T_k, B = Σ of T_kᵀ M at k and −T_kᵀ M T at i; the result is
/// gᵀ (I − B Σ Bᵀ)⁻¹ g. Of a loop written against the first one δ moves the `from`, which to first
/// order is −δ of its `to`: T_k changes its sign. `equations` are factorised at `nodes`, their
/// minimum, with these weights.
double group_chi2(NormalEquations& equations, const std::vector<std::size_t>& group,
                  std::span<const double> weights, std::span<const Node> nodes);

}  // namespace fathom::sparse_gauss_newton
