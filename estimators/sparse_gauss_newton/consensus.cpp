#include "estimators/sparse_gauss_newton/consensus.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "estimators/sparse_gauss_newton/drift.hpp"
#include "estimators/sparse_gauss_newton/leave_one_out.hpp"
#include "estimators/sparse_gauss_newton/loop_groups.hpp"
#include "fathom/estimation/robust_loss.hpp"

namespace fathom::sparse_gauss_newton {
namespace {

constexpr int kPasses = 10;
constexpr int kRounds = 60;
constexpr int kWeightRounds = 20;
constexpr double kWeightsSettled = 0.01;
// A loop that was put out so often is not let in again: it would go on for ever.
constexpr int kMostExpulsions = 2;
// Outside, a loop is looked at if its residual is within so many scales; where there are too few
// loops inside to hold the map, or it is new, if dead reckoning alone could explain a fair part of
// its residual. The others would only fill the factor.
constexpr double kHopeless = 1e3;
constexpr double kHopelessOfDrift = 4.0;
constexpr double kEnoughInside = 1.0 / 3.0;
// Real loops have heavier tails than χ²₃: left out, the largest of a set is 1.1 to 9.3 times their
// 90 % quantile (docs/robustness.md). The ramp of weights ends at 10 times it.
constexpr double kScaleOfQuantile = 10.0 / 1.5;
constexpr double kQuantile = 0.9;
constexpr std::size_t kLoopsForScale = 10;
constexpr double kLeastScale = 0.01;  // of the default: agreement beyond it is no news
constexpr SolveLimits kRough{20, 1e-6};

// Of the whole graph those edges that count or may come to, with a pattern of their own.
class Part {
 public:
  Part(const LoopGraph& graph, const std::vector<std::size_t>& indices, std::size_t keyframes)
      : edges_(pick(graph.edges, indices)),
        is_loop_(pick(graph.is_loop, indices)),
        symbolic_(analyse_graph(edges_, static_cast<int>(keyframes))),
        equations_(symbolic_, edges_) {}

  SolveResult solve(std::vector<Node>& nodes, std::span<const double> weights,
                    const SolveLimits& limits) {
    equations_.set_loss({RobustLoss(), {}, weights});
    return minimise(equations_, nodes, limits);
  }

  std::vector<double> leave_one_out(std::span<const double> weights, std::span<const Node> nodes) {
    return sparse_gauss_newton::leave_one_out(equations_, is_loop_, weights, nodes);
  }

  /// Groups of the loops with weight; group_chi2 is at the factor of the last leave_one_out.
  std::vector<std::vector<std::size_t>> groups(std::span<const double> weights) const {
    std::vector<std::size_t> kept;
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      if (is_loop_[e] != 0 && weights[e] > 0.0) kept.push_back(e);
    }
    const auto any = [](const Edge&, const Edge&) { return true; };
    return group_loops(edges_, std::move(kept), any);
  }

  double group_chi2(const std::vector<std::size_t>& group, std::span<const double> weights,
                    std::span<const Node> nodes) {
    return sparse_gauss_newton::group_chi2(equations_, group, weights, nodes);
  }

  bool is_loop(std::size_t e) const { return is_loop_[e] != 0; }

 private:
  template <class T>
  static std::vector<T> pick(std::span<const T> all, const std::vector<std::size_t>& indices) {
    std::vector<T> part;
    part.reserve(indices.size());
    for (const std::size_t e : indices) part.push_back(all[e]);
    return part;
  }

  std::vector<Edge> edges_;
  std::vector<char> is_loop_;
  sparse::Symbolic symbolic_;
  NormalEquations equations_;
};

class Search {
 public:
  Search(const LoopGraph& graph, std::vector<double> weights, std::vector<Node>& nodes,
         std::optional<double> squared_scale, const SolveLimits& limits)
      : graph_(graph),
        weights_(std::move(weights)),
        nodes_(nodes),
        limits_(limits),
        expulsions_(graph.edges.size(), 0),
        adapts_(!squared_scale) {
    const double by_default = default_scale(LossKind::truncated);
    largest_ = scale_ = squared_scale.value_or(by_default * by_default);
    for (double& weight : weights_) {
      is_new_.push_back(weight == kNewLoop ? 1 : 0);
      weight = weight >= 0.5 ? 1.0 : 0.0;
    }
  }

  Consensus run() {
    for (int pass = 0; pass < kPasses; ++pass) {
      take_part();
      const bool let_in = judge();
      hand_back();
      if (!let_in && pass > 0) break;
    }
    take_part();
    settle_weights();
    Consensus result;
    result.solved = part_->solve(nodes_, own_, limits_);
    result.solved.iterations += iterations_;
    hand_back();
    result.weights = std::move(weights_);
    result.squared_scale = scale_;
    return result;
  }

 private:
  double residual_of(const Edge& edge) const {
    return linearise_edge(edge, nodes_[at(edge.from)], nodes_[at(edge.to)]).cost;
  }

  double share_inside() const {
    double loops = 0.0;
    double inside = 0.0;
    for (std::size_t e = 0; e < graph_.edges.size(); ++e) {
      if (graph_.is_loop[e] == 0) continue;
      loops += 1.0;
      if (weights_[e] > 0.0) inside += 1.0;
    }
    return loops > 0.0 ? inside / loops : 1.0;
  }

  void take_part() {
    indices_.clear();
    own_.clear();
    const Drift drift(graph_.edges, graph_.is_loop, nodes_);
    const bool is_vague = share_inside() < kEnoughInside;
    for (std::size_t e = 0; e < graph_.edges.size(); ++e) {
      const Edge& edge = graph_.edges[e];
      const bool may_enter = weights_[e] == 0.0 && expulsions_[e] < kMostExpulsions &&
                             (residual_of(edge) < kHopeless * scale_ ||
                              ((is_vague || is_new_[e] != 0) &&
                               least_chi2(drift, edge, nodes_) < kHopelessOfDrift * scale_));
      if (weights_[e] == 0.0 && !may_enter) continue;
      indices_.push_back(e);
      own_.push_back(weights_[e]);
    }
    part_.emplace(graph_, indices_, nodes_.size());
  }

  void hand_back() {
    for (std::size_t j = 0; j < indices_.size(); ++j) weights_[indices_[j]] = own_[j];
  }

  // Whether any was let in.
  bool judge() {
    bool any = false;
    for (int round = 0; round < kRounds; ++round) {
      iterations_ += part_->solve(nodes_, own_, kRough).iterations;
      const std::vector<double> chi2 = part_->leave_one_out(own_, nodes_);
      adapt_scale(chi2);
      if (put_out(chi2)) continue;
      if (let_in(chi2)) {
        any = true;
      } else if (!put_out_groups()) {
        return any;
      }
    }
    return any;
  }

  void adapt_scale(const std::vector<double>& chi2) {
    if (!adapts_) return;
    std::vector<double> inside;
    for (std::size_t j = 0; j < own_.size(); ++j) {
      if (part_->is_loop(j) && own_[j] > 0.0) inside.push_back(chi2[j]);
    }
    if (inside.size() < kLoopsForScale) return;
    const auto place = static_cast<std::ptrdiff_t>(kQuantile * static_cast<double>(inside.size()));
    std::nth_element(inside.begin(), inside.begin() + place, inside.end());
    scale_ = std::clamp(kScaleOfQuantile * inside[static_cast<std::size_t>(place)],
                        kLeastScale * largest_, largest_);
  }

  // The worst, and those that are half as bad: a false loop spoils what is said of its neighbours.
  bool put_out(const std::vector<double>& chi2) {
    double worst = 1.5 * scale_;
    for (std::size_t j = 0; j < own_.size(); ++j) {
      if (own_[j] > 0.0) worst = std::max(worst, chi2[j]);
    }
    bool any = false;
    for (std::size_t j = 0; j < own_.size(); ++j) {
      if (own_[j] == 0.0 || chi2[j] <= 1.5 * scale_ || chi2[j] < 0.5 * worst) continue;
      own_[j] = 0.0;
      ++expulsions_[indices_[j]];
      any = true;
    }
    return any;
  }

  std::vector<std::size_t> in_graph(std::vector<std::size_t> group) const {
    for (std::size_t& j : group) j = indices_[j];
    return group;
  }

  // Of the groups that the rest contradicts, those with most against each of their loops.
  bool put_out_groups() {
    std::vector<std::pair<double, std::vector<std::size_t>>> contradicted;
    double most = 0.0;
    for (std::vector<std::size_t>& group : part_->groups(own_)) {
      if (group.size() < 2 || calm_groups_.contains(in_graph(group))) continue;
      const double chi2 = part_->group_chi2(group, own_, nodes_);
      // Three solves a group: one that is far from being put out is not asked again.
      if (chi2 <= 0.5 * scale_) calm_groups_.insert(in_graph(group));
      if (chi2 <= 1.5 * scale_) continue;
      const double each = chi2 / static_cast<double>(group.size());
      most = std::max(most, each);
      contradicted.emplace_back(each, std::move(group));
    }
    for (const auto& [each, group] : contradicted) {
      if (each < 0.5 * most) continue;
      for (const std::size_t j : group) {
        own_[j] = 0.0;
        ++expulsions_[indices_[j]];
      }
    }
    return !contradicted.empty();
  }

  bool let_in(const std::vector<double>& chi2) {
    bool any = false;
    for (std::size_t j = 0; j < own_.size(); ++j) {
      if (own_[j] > 0.0 || chi2[j] > 1.5 * scale_) continue;
      if (expulsions_[indices_[j]] >= kMostExpulsions) continue;
      own_[j] = 1.0;
      any = true;
    }
    return any;
  }

  void settle_weights() {
    for (int round = 0; round < kWeightRounds; ++round) {
      iterations_ += part_->solve(nodes_, own_, kRough).iterations;
      const std::vector<double> chi2 = part_->leave_one_out(own_, nodes_);
      double change = 0.0;
      for (std::size_t j = 0; j < own_.size(); ++j) {
        if (!part_->is_loop(j)) continue;
        const double weight = std::clamp(1.5 - chi2[j] / scale_, 0.0, 1.0);
        change = std::max(change, std::abs(weight - own_[j]));
        own_[j] = 0.5 * (own_[j] + weight);
        if (own_[j] < kWeightsSettled) own_[j] = 0.0;
      }
      if (change < kWeightsSettled) return;
    }
  }

  LoopGraph graph_;
  std::vector<double> weights_;
  std::vector<Node>& nodes_;
  SolveLimits limits_;
  std::vector<int> expulsions_;
  std::vector<char> is_new_;
  bool adapts_;
  double scale_ = 0.0;
  double largest_ = 0.0;
  std::vector<std::size_t> indices_;  ///< of the part, in the graph
  std::vector<double> own_;           ///< weights of the part
  std::set<std::vector<std::size_t>> calm_groups_;
  std::optional<Part> part_;
  int iterations_ = 0;
};

}  // namespace

Consensus find_consensus(const LoopGraph& graph, std::vector<double> weights,
                         std::vector<Node>& nodes, std::optional<double> squared_scale,
                         const SolveLimits& limits) {
  return Search(graph, std::move(weights), nodes, squared_scale, limits).run();
}

double truncated_cost(const LoopGraph& graph, std::span<const double> weights,
                      std::span<const Node> nodes, double squared_scale) {
  double sum = 0.0;
  for (std::size_t e = 0; e < graph.edges.size(); ++e) {
    const Edge& edge = graph.edges[e];
    const double chi2 = linearise_edge(edge, nodes[at(edge.from)], nodes[at(edge.to)]).cost;
    sum += weights[e] * chi2 + (1.0 - weights[e]) * squared_scale;
  }
  return sum;
}

}  // namespace fathom::sparse_gauss_newton
