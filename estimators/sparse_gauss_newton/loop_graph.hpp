#pragma once

#include <span>

#include "estimators/support/pose_graph/batch.hpp"

namespace fathom::sparse_gauss_newton {

// What this folder takes from the support of pose graphs.
using pose_graph::analyse_graph;
using pose_graph::covariance_of;
using pose_graph::Edge;
using pose_graph::EdgeTerms;
using pose_graph::full;
using pose_graph::Hessian;
using pose_graph::linearise_edge;
using pose_graph::make_edge;
using pose_graph::make_node;
using pose_graph::minimise;
using pose_graph::Node;
using pose_graph::NormalEquations;
using pose_graph::pose_of;
using pose_graph::residual_of;
using pose_graph::SolveLimits;
using pose_graph::SolveResult;
using pose_graph::Start;
using sparse::at;

/// A graph and which of its edges are loops.
struct LoopGraph {
  std::span<const Edge> edges;
  std::span<const char> is_loop;
  std::span<const char> ranks{};  ///< of each edge's information; empty: all 3
  Workers* workers = nullptr;     ///< who solves it; null: the calling thread alone

  int rank(std::size_t edge) const { return ranks.empty() ? 3 : ranks[edge]; }
  /// χ² of an edge with so many degrees of freedom as one of a registration: what is as unlikely.
  double as_registration(std::size_t edge, double chi2) const {
    return ranks.empty() ? chi2 : chi2 / squared_scale_share(LossKind::truncated, ranks[edge]);
  }
};

}  // namespace fathom::sparse_gauss_newton
