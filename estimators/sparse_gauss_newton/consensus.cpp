#include "estimators/sparse_gauss_newton/consensus.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "estimators/sparse_gauss_newton/candidates.hpp"
#include "estimators/sparse_gauss_newton/drift.hpp"
#include "fathom/estimation/robust_loss.hpp"

namespace fathom::sparse_gauss_newton {
namespace {

class Search {
 public:
  Search(const LoopGraph& graph, std::vector<double> weights, std::vector<Node>& nodes,
         const ConsensusOptions& options)
      : graph_(graph),
        weights_(std::move(weights)),
        nodes_(nodes),
        options_(options),
        rejections_(graph.edges.size(), 0) {
    const double by_default = default_scale(LossKind::truncated);
    largest_ = scale_ = options.squared_scale.value_or(by_default * by_default);
    for (double& weight : weights_) {
      is_new_.push_back(weight == kNewLoop ? 1 : 0);
      weight = weight >= 0.5 ? 1.0 : 0.0;
    }
  }

  Consensus run() {
    for (int pass = 0; pass < tuning().passes; ++pass) {
      choose_candidates();
      const bool readmitted = judge();
      hand_back();
      if (!readmitted && pass > 0) break;
    }
    choose_candidates();
    settle_weights();
    Consensus result;
    result.solved = candidates_->solve(nodes_, own_, options_.limits);
    result.solved.iterations += iterations_;
    hand_back();
    result.weights = std::move(weights_);
    result.squared_scales = {scale_, largest_};
    return result;
  }

 private:
  const LoopJudgement& tuning() const { return options_.judgement; }
  double limit() const { return tuning().reject_at * scale_; }

  // As of a registration, χ² of an edge times this is to be compared with scale_.
  double to_scale(std::size_t e) const { return graph_.rank(e) == 3 ? 1.0 : scale_ / largest_; }

  double chi2_of(std::size_t e) const {
    const Edge& edge = graph_.edges[e];
    const double chi2 = linearise_edge(edge, nodes_).cost;
    return to_scale(e) * graph_.as_registration(e, chi2);
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

  bool may_return(std::size_t e, const Drift& drift, bool few_inside) const {
    if (rejections_[e] >= tuning().max_rejections) return false;
    if (chi2_of(e) < tuning().candidate_reach * scale_) return true;
    if (!few_inside && is_new_[e] == 0) return false;
    const double least = least_chi2(drift, graph_.edges[e], graph_.rank(e), nodes_);
    return to_scale(e) * graph_.as_registration(e, least) < tuning().drift_reach * scale_;
  }

  void choose_candidates() {
    std::vector<std::size_t> indices;
    own_.clear();
    const Drift drift(graph_.edges, graph_.is_loop, nodes_);
    const bool few_inside = share_inside() < tuning().few_share;
    for (std::size_t e = 0; e < graph_.edges.size(); ++e) {
      if (weights_[e] == 0.0 && !may_return(e, drift, few_inside)) continue;
      indices.push_back(e);
      own_.push_back(weights_[e]);
    }
    candidates_.emplace(graph_, std::move(indices), nodes_.size());
  }

  void hand_back() {
    for (std::size_t j = 0; j < own_.size(); ++j) weights_[candidates_->index(j)] = own_[j];
  }

  std::vector<double> solved_and_left_out() {
    iterations_ += candidates_->solve(nodes_, own_, tuning().judged_solve).iterations;
    return candidates_->leave_one_out(own_, nodes_);
  }

  // Whether any was readmitted.
  bool judge() {
    bool any = false;
    for (int round = 0; round < tuning().rounds; ++round) {
      std::vector<double> chi2 = solved_and_left_out();
      adapt_scale(chi2);
      bring_to_scale(chi2);
      if (reject(chi2)) continue;
      if (readmit(chi2)) {
        any = true;
      } else if (!reject_groups()) {
        return any;
      }
    }
    return any;
  }

  void adapt_scale(const std::vector<double>& chi2) {
    if (options_.squared_scale) return;
    std::vector<double> inside;
    for (std::size_t j = 0; j < own_.size(); ++j) {
      // What an absolute measurement says of its σ is no word on that of registrations.
      if (candidates_->is_registration(j) && own_[j] > 0.0) inside.push_back(chi2[j]);
    }
    if (inside.size() < static_cast<std::size_t>(tuning().scale_loops)) return;
    const auto place =
        static_cast<std::ptrdiff_t>(tuning().scale_quantile * static_cast<double>(inside.size()));
    std::nth_element(inside.begin(), inside.begin() + place, inside.end());
    scale_ = std::clamp(
        tuning().scale_factor / tuning().reject_at * inside[static_cast<std::size_t>(place)],
        tuning().least_scale_share * largest_, largest_);
  }

  void bring_to_scale(std::vector<double>& chi2) const {
    for (std::size_t j = 0; j < chi2.size(); ++j) chi2[j] *= to_scale(candidates_->index(j));
  }

  void reject_one(std::size_t j) {
    own_[j] = 0.0;
    ++rejections_[candidates_->index(j)];
  }

  // The worst, and those that are half as bad.
  bool reject(const std::vector<double>& chi2) {
    double worst = limit();
    for (std::size_t j = 0; j < own_.size(); ++j) {
      if (own_[j] > 0.0) worst = std::max(worst, chi2[j]);
    }
    bool any = false;
    for (std::size_t j = 0; j < own_.size(); ++j) {
      if (own_[j] == 0.0 || chi2[j] <= limit() || chi2[j] < tuning().worst_share * worst) continue;
      reject_one(j);
      any = true;
    }
    return any;
  }

  std::vector<std::size_t> in_graph(std::vector<std::size_t> group) const {
    for (std::size_t& j : group) j = candidates_->index(j);
    return group;
  }

  // Of the groups that the rest contradicts, those with most against each of their loops.
  bool reject_groups() {
    std::vector<std::pair<double, std::vector<std::size_t>>> contradicted;
    double most = 0.0;
    for (std::vector<std::size_t>& group : candidates_->groups(own_, tuning().group_reach)) {
      if (group.size() < 2 || settled_groups_.contains(in_graph(group))) continue;
      const double chi2 = candidates_->group_chi2(group, own_, nodes_);
      if (chi2 <= tuning().settled_group_share * scale_) settled_groups_.insert(in_graph(group));
      const double each = chi2 / static_cast<double>(group.size());
      if (chi2 <= limit() || each <= tuning().group_loop_share * scale_) continue;
      most = std::max(most, each);
      contradicted.emplace_back(each, std::move(group));
    }
    for (const auto& [each, group] : contradicted) {
      if (each < tuning().worst_share * most) continue;
      for (const std::size_t j : group) reject_one(j);
    }
    return !contradicted.empty();
  }

  bool readmit(const std::vector<double>& chi2) {
    bool any = false;
    for (std::size_t j = 0; j < own_.size(); ++j) {
      if (own_[j] > 0.0 || chi2[j] > limit()) continue;
      if (rejections_[candidates_->index(j)] >= tuning().max_rejections) continue;
      own_[j] = 1.0;
      any = true;
    }
    return any;
  }

  // Half way to the new weights each time: all at once they may swing.
  void settle_weights() {
    for (int round = 0; round < tuning().weight_rounds; ++round) {
      std::vector<double> chi2 = solved_and_left_out();
      bring_to_scale(chi2);
      double change = 0.0;
      for (std::size_t j = 0; j < own_.size(); ++j) {
        if (!candidates_->is_loop(j)) continue;
        const double weight = std::clamp(tuning().reject_at - chi2[j] / scale_, 0.0, 1.0);
        change = std::max(change, std::abs(weight - own_[j]));
        own_[j] = 0.5 * (own_[j] + weight);
        if (own_[j] < tuning().weight_tolerance) own_[j] = 0.0;
      }
      if (change < tuning().weight_tolerance) return;
    }
  }

  LoopGraph graph_;
  std::vector<double> weights_;
  std::vector<Node>& nodes_;
  ConsensusOptions options_;
  std::vector<int> rejections_;  ///< by edge
  std::vector<char> is_new_;
  double scale_ = 0.0;    ///< c² of registrations
  double largest_ = 0.0;  ///< that of all others, too
  std::optional<Candidates> candidates_;
  std::vector<double> own_;  ///< weights of the candidates
  std::set<std::vector<std::size_t>> settled_groups_;
  int iterations_ = 0;
};

}  // namespace

Consensus find_consensus(const LoopGraph& graph, std::vector<double> weights,
                         std::vector<Node>& nodes, const ConsensusOptions& options) {
  return Search(graph, std::move(weights), nodes, options).run();
}

double truncated_cost(const LoopGraph& graph, std::span<const double> weights,
                      std::span<const Node> nodes, const SquaredScales& squared_scales) {
  double sum = 0.0;
  for (std::size_t e = 0; e < graph.edges.size(); ++e) {
    const Edge& edge = graph.edges[e];
    const double chi2 = linearise_edge(edge, nodes).cost;
    sum += weights[e] * chi2 + (1.0 - weights[e]) * squared_scales.of_rank(graph.rank(e));
  }
  return sum;
}

}  // namespace fathom::sparse_gauss_newton
