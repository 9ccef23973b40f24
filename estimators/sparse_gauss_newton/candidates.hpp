#pragma once

#include <optional>
#include <span>
#include <vector>

#include "estimators/sparse_gauss_newton/loop_judgement.hpp"

namespace fathom::sparse_gauss_newton {

/// Of a graph those edges that count or may come to, with a pattern of their own: all but the
/// loops that are far from being readmitted.
class Candidates {
 public:
  /// `edges`: their indices in the graph, rising.
  Candidates(const LoopGraph& graph, std::vector<std::size_t> edges, std::size_t keyframes);

  std::size_t size() const { return edges_.size(); }
  /// Of a candidate, in the graph.
  std::size_t index(std::size_t candidate) const { return indices_[candidate]; }
  bool is_loop(std::size_t candidate) const { return is_loop_[candidate] != 0; }
  /// A loop that measures all of a motion.
  bool is_registration(std::size_t candidate) const {
    return is_loop(candidate) && (ranks_.empty() || ranks_[candidate] == 3);
  }

  SolveResult solve(std::vector<Node>& nodes, std::span<const double> weights,
                    const SolveLimits& limits);

  /// See leave_one_out.hpp.
  std::vector<double> leave_one_out(std::span<const double> weights, std::span<const Node> nodes);

  /// Groups of the loops with weight, and group_chi2 at the factor of the last leave_one_out.
  std::vector<std::vector<std::size_t>> groups(std::span<const double> weights, int reach) const;
  double group_chi2(const std::vector<std::size_t>& group, std::span<const double> weights,
                    std::span<const Node> nodes);

 private:
  std::vector<std::size_t> indices_;
  std::vector<Edge> edges_;
  std::vector<char> is_loop_;
  std::vector<char> ranks_;  ///< empty: all 3
  sparse::Symbolic symbolic_;
  NormalEquations equations_;
};

}  // namespace fathom::sparse_gauss_newton
