#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "estimators/sparse_gauss_newton/consensus.hpp"

namespace fathom::sparse_gauss_newton {

/// Groups of two or more loops that a consensus left out and that agree with one another: between
/// neighbours of neighbours, and each predicted by another with the motions of the estimate among
/// them. Either one false place taken for another, or right ones that a wrong fold of the map
/// shuts out. The largest first; indices of edges.
std::vector<std::vector<std::size_t>> lost_groups(const LoopGraph& graph,
                                                  const Consensus& consensus,
                                                  std::span<const Node> nodes,
                                                  const LoopJudgement& judgement);

}  // namespace fathom::sparse_gauss_newton
