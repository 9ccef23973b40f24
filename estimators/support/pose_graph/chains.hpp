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
  /// `count` steps lead from keyframe `begin`, the chain's own in this graph, to `begin` + count.
  struct Chain {
    int begin = 0;
    int count = 0;
    bool is_open = false;  ///< nothing measures its end
  };

  /// `edges` must outlive it.
  ChainGraph(std::span<const Edge> edges, std::span<const Node> nodes);

  /// Whether it has chains worth their elimination (ChainEquations); no errors of pictures are
  /// unknowns, and the steps that are left out measure all three coordinates.
  bool has_chains() const { return has_chains_; }
  /// Has the edges of the chains state what these measure. False where the graph is not a smaller
  /// problem by far, or not the same one: all steps of a chain must measure all three coordinates.
  bool measure();

  /// Those of the chains that are not open in front, one each, then all others.
  std::span<const Edge> edges() const { return edges_; }
  const std::vector<Node>& nodes() const { return nodes_; }

  /// All keyframes for poses of those of this graph, where measure() is done: what a chain's end is
  /// off is distributed over its steps such that νᵀ W ν is least.
  std::vector<Node> expanded(std::span<const Node> nodes) const;

  /// In the order of the keyframes; one that is open is the last.
  std::span<const Chain> chains() const { return chains_; }
  const Edge& step(const Chain& chain, int t) const {
    return all_[at(steps_[at(chain.begin + t)])];
  }
  /// Keyframes that are left out follow their steps from the last one that is not.
  void follow_open_chain(std::vector<Node>& all) const;

 private:
  bool find_chains(std::size_t keyframes);
  bool is_share(std::size_t left, double most) const;
  bool find_edges();
  bool find_covariances();
  /// What the steps of a chain measure, as one edge.
  void measure(std::size_t chain);
  /// The measured path of a chain in the frame of its begin, `count` + 1 poses.
  const Node* path_of(std::size_t chain) const {
    return paths_.data() + at(chains_[chain].begin) + chain;
  }
  Node* path_of(std::size_t chain) { return paths_.data() + at(chains_[chain].begin) + chain; }

  struct Expansion {
    std::vector<Node> path;
    std::vector<Eigen::Vector3d> errors;  ///< of the steps
  };
  void expand(std::size_t chain, const Node& end, Expansion& work, std::vector<Node>& all) const;

  std::span<const Edge> all_;
  std::vector<int> steps_;  ///< by keyframe, the edge to the next one
  std::vector<Eigen::Matrix3d> covariances_;
  std::vector<Node> paths_;
  std::vector<Chain> chains_;
  std::vector<Edge> edges_;
  std::vector<Node> nodes_;
  std::size_t keyframes_ = 0;
  bool has_chains_ = false;
};

}  // namespace fathom::pose_graph
