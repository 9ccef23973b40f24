#pragma once

#include <algorithm>
#include <vector>

#include "estimators/incremental_smoother/local_edge.hpp"
#include "estimators/incremental_smoother/variables.hpp"

namespace fathom::incremental_smoother {

/// A robust loss on the loops among the edges: F = Σ s over the steps + Σ ρ(s) over the loops, with
/// s = νᵀ W ν. A loop's gradient and blocks are those of an edge with ρ'(s) W: what it weighs at
/// the estimate goes into the gradient, what it weighed when its clique was factored last is in
/// the tree. Without a loss it holds nothing, and every edge counts as it stands.
class LoopWeights {
 public:
  explicit LoopWeights(const RobustLoss& loss = {}) : loss_(loss) {}

  bool is_on() const { return loss_.is_on(); }
  const RobustLoss& loss() const { return loss_; }
  /// Whether the loss is on this edge.
  bool has(int edge) const { return is_on() && is_loop_[at(edge)] != 0; }

  /// The next edge; its loss is that of the rank of its information (RobustLoss::of_rank).
  void add(bool is_loop, int rank) {
    if (!is_on()) return;
    is_loop_.push_back(is_loop ? 1 : 0);
    ranks_.push_back(static_cast<char>(rank));
    present_.push_back(1.0);
    factored_.push_back(1.0);
  }

  void forget(int count) {
    if (!is_on()) return;
    is_loop_.resize(at(count));
    ranks_.resize(at(count));
    present_.resize(at(count));
    factored_.resize(at(count));
  }

  /// An edge at the estimate: F and its gradient with the loss, if it has one.
  void apply(int edge, EdgeGradient& t) {
    if (!has(edge)) return;
    const LossValue value = loss_.of_rank(ranks_[at(edge)]).at(t.cost);
    present_[at(edge)] = value.weight;
    t.cost = value.rho;
    for (double& element : t.from) element *= value.weight;
    for (double& element : t.to) element *= value.weight;
  }

  /// What it weighs at the estimate, as `apply` found it last.
  double present(int edge) const { return has(edge) ? present_[at(edge)] : 1.0; }

  /// That weight goes into the tree.
  double factor(int edge) { return factored_[at(edge)] = present_[at(edge)]; }

  /// Whether what it weighs differs from what is in the tree by more than this share of the lesser.
  bool has_left_tree(int edge, double share) const {
    if (!has(edge)) return false;
    const auto [least, most] = std::minmax(present_[at(edge)], factored_[at(edge)]);
    return most > (1.0 + share) * least;
  }

  /// By edge, whether the loss is on it, and the rank of its information; empty without a loss.
  const std::vector<char>& is_loop() const { return is_loop_; }
  const std::vector<char>& ranks() const { return ranks_; }

 private:
  RobustLoss loss_;
  // By edge.
  std::vector<char> is_loop_;
  std::vector<char> ranks_;
  std::vector<double> present_;
  std::vector<double> factored_;
};

}  // namespace fathom::incremental_smoother
