#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "estimators/support/pose_graph/edge.hpp"

namespace fathom::pose_graph {

/// A graph without the keyframes that only their two steps measure. Such a keyframe can be
/// eliminated in closed form: the steps of a chain of them are one measurement, with the composed
/// motion and, to first order, the covariance Σ_t A_t C_t A_tᵀ of its end in the frame of its
/// begin; A_t says what an error of step t does there. Keyframes behind the last one that is
/// measured otherwise are left out altogether: their steps are satisfied whatever the rest is.
class ChainGraph {
 public:
  /// `edges` must outlive it.
  ChainGraph(std::span<const Edge> edges, std::span<const Node> nodes);

  /// Whether it is a smaller problem by far, and the same one: of every chain all steps measure all
  /// three coordinates, and no errors of pictures are unknowns.
  bool is_worthwhile() const { return is_worthwhile_; }

  std::span<const Edge> edges() const { return edges_; }
  const std::vector<Node>& nodes() const { return nodes_; }

  /// All keyframes for poses of those of this graph: what a chain's end is off is distributed over
  /// its steps such that νᵀ W ν is least.
  std::vector<Node> expanded(std::span<const Node> nodes) const;

 private:
  /// `count` steps lead from keyframe `begin`, the chain's own in this graph, to `begin` + count.
  struct Chain {
    int begin = 0;
    int count = 0;
    bool is_open = false;  ///< nothing measures its end
  };

  bool find_chains(std::size_t keyframes);
  Edge composed(const Chain& chain) const;
  void expand(const Chain& chain, const Node& end, std::vector<Node>& all) const;
  /// Poses along a chain from its begin, each step's measured motion corrected by `errors`.
  void compose(const Chain& chain, std::span<const Eigen::Vector3d> errors,
               std::vector<Node>& all) const;
  const Edge& step(const Chain& chain, int t) const {
    return all_[at(steps_[at(chain.begin + t)])];
  }

  std::span<const Edge> all_;
  std::vector<int> steps_;  ///< by keyframe, the edge to the next one
  std::vector<Eigen::Matrix3d> covariances_;
  std::vector<Chain> chains_;
  std::vector<Edge> edges_;
  std::vector<Node> nodes_;
  std::size_t keyframes_ = 0;
  bool is_worthwhile_ = false;
};

}  // namespace fathom::pose_graph
