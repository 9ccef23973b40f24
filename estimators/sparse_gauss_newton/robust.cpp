#include "estimators/sparse_gauss_newton/robust.hpp"

#include <algorithm>
#include <utility>

#include "estimators/sparse_gauss_newton/lost_groups.hpp"

namespace fathom::sparse_gauss_newton {
namespace {

// By so much less, as a share, F is better and no rounding.
constexpr double kRounding = 1e-6;

class RobustBatch {
 public:
  RobustBatch(const LoopGraph& graph, const RobustOptions& options, const SolveLimits& limits,
              std::size_t keyframes)
      : graph_(graph),
        options_(options),
        limits_(limits),
        symbolic_(analyse_graph(graph.edges, static_cast<int>(keyframes), graph.workers)),
        equations_(symbolic_, graph.edges) {}

  RobustResult descend(std::vector<Node>& nodes, bool from_scratch) {
    const std::vector<Node> start = nodes;
    SolveResult solved = descent(nodes);
    if (from_scratch) try_plain_descent(start, nodes, solved);
    solved.iterations = iterations_;
    return {solved, weights_at(nodes, options_.loss)};
  }

  // Geman-McClure leads near, then the loops are judged by one another.
  RobustResult agree(std::vector<Node>& nodes, std::span<const double> known) {
    if (!known.empty()) {
      Consensus consensus = consensus_from({known.begin(), known.end()}, nodes);
      return {consensus.solved, std::move(consensus.weights), consensus.squared_scales};
    }
    const std::vector<Node> start = nodes;
    Consensus best = attempt(nodes, {});
    try_lost_groups(start, nodes, best);
    try_plain_attempt(start, nodes, best);
    try_free_start(nodes, best);
    best.solved.iterations += iterations_;
    return {best.solved, std::move(best.weights), best.squared_scales};
  }

 private:
  const LoopJudgement& tuning() const { return options_.judgement; }

  Consensus consensus_from(std::vector<double> weights, std::vector<Node>& nodes) const {
    return find_consensus(graph_, std::move(weights), nodes,
                          {tuning(), options_.squared_scale, limits_});
  }

  RobustLoss leading_loss() const {
    if (options_.loss.kind() != LossKind::truncated) return options_.loss;
    LossOptions leading{LossKind::geman_mcclure, std::nullopt};
    if (options_.squared_scale) {
      leading.scale = scale_of_half_weight(leading.kind, *options_.squared_scale);
    }
    return RobustLoss(leading);
  }

  SolveResult minimise_with(const RobustLoss& loss, std::vector<Node>& nodes,
                            const std::vector<char>& is_robust, const SolveLimits& limits) {
    equations_.set_loss({loss, is_robust.empty() ? graph_.is_loop : is_robust, {}, graph_.ranks});
    const SolveResult solved = minimise(equations_, nodes, limits);
    iterations_ += solved.iterations;
    return solved;
  }

  void graduate(std::vector<Node>& nodes, const std::vector<char>& is_robust) {
    const RobustLoss loss = leading_loss();
    if (options_.graduation == Graduation::off || loss.kind() != LossKind::geman_mcclure) return;
    double largest = 0.0;
    for (std::size_t e = 0; e < graph_.edges.size(); ++e) {
      if (graph_.is_loop[e] != 0) largest = std::max(largest, chi2_of(e, nodes));
    }
    double mu = 2.0 * largest / loss.squared_scale();
    while (mu > 1.0) {
      minimise_with(loss.widened(mu), nodes, is_robust, kGraduationSolve);
      mu /= kGraduationStep;
    }
  }

  SolveResult descent(std::vector<Node>& nodes) {
    graduate(nodes, {});
    return minimise_with(options_.loss, nodes, {}, limits_);
  }

  // The least squares of the whole graph. Where steps are weak or missing the given start is
  // worthless, and a loss that starts there ends in a jumble.
  std::vector<Node> plain_solution(std::vector<Node> nodes) {
    const SolveResult plain =
        pose_graph::solve_batch(graph_.edges, nodes, Start::automatic, limits_, graph_.workers);
    iterations_ += plain.iterations;
    return nodes;
  }

  double robust_cost(std::span<const Node> nodes, const RobustLoss& loss) const {
    double sum = 0.0;
    for (std::size_t e = 0; e < graph_.edges.size(); ++e) {
      const double chi2 = chi2_of(e, nodes);
      sum += graph_.is_loop[e] != 0 ? loss.of_rank(graph_.rank(e)).at(chi2).rho : chi2;
    }
    return sum;
  }

  // Of each loop whichever is less, its χ² or the scale.
  double least_truncated_cost(std::span<const Node> nodes, const SquaredScales& scales) const {
    double sum = 0.0;
    for (std::size_t e = 0; e < graph_.edges.size(); ++e) {
      const double chi2 = chi2_of(e, nodes);
      sum += graph_.is_loop[e] != 0 ? std::min(chi2, scales.of_rank(graph_.rank(e))) : chi2;
    }
    return sum;
  }

  // From the plain solution too, if the loss holds that for better than where it ended.
  void try_plain_descent(const std::vector<Node>& start, std::vector<Node>& nodes,
                         SolveResult& best) {
    std::vector<Node> other = plain_solution(start);
    const double reached = robust_cost(nodes, options_.loss);
    const bool is_settled = best.outcome == Outcome::converged;
    if (is_settled && !(robust_cost(other, options_.loss) < reached)) return;
    const SolveResult solved = descent(other);
    if (!is_done(solved.outcome)) return;
    if (is_done(best.outcome) && !(solved.cost < best.cost)) return;
    best = solved;
    nodes = std::move(other);
  }

  void try_plain_attempt(const std::vector<Node>& start, std::vector<Node>& nodes,
                         Consensus& best) {
    std::vector<Node> other = plain_solution(start);
    const SquaredScales& scales = best.squared_scales;
    const double reached = truncated_cost(graph_, best.weights, nodes, scales);
    if (is_done(best.solved.outcome) && !(least_truncated_cost(other, scales) < reached)) return;
    Consensus consensus = attempt(other, {});
    if (!is_better(consensus, other, best, nodes)) return;
    iterations_ += best.solved.iterations;
    best = std::move(consensus);
    nodes = std::move(other);
  }

  // `trusted` loops are taken for right at first.
  Consensus attempt(std::vector<Node>& nodes, const std::vector<std::size_t>& trusted) {
    std::vector<char> is_robust(graph_.is_loop.begin(), graph_.is_loop.end());
    for (const std::size_t e : trusted) is_robust[e] = 0;
    graduate(nodes, is_robust);
    minimise_with(leading_loss(), nodes, is_robust, tuning().leading_solve);
    std::vector<double> weights = weights_at(nodes, leading_loss());
    for (double& weight : weights) weight = weight >= tuning().first_weight ? 1.0 : 0.0;
    for (const std::size_t e : trusted) weights[e] = 1.0;
    return consensus_from(std::move(weights), nodes);
  }

  // A wrong fold shuts right loops out, many together: the largest such groups are trusted in turn.
  void try_lost_groups(const std::vector<Node>& start, std::vector<Node>& nodes, Consensus& best) {
    std::vector<std::vector<std::size_t>> groups = lost_groups(graph_, best, nodes, tuning());
    for (std::size_t tries = 0;
         tries <
         std::min<std::size_t>(static_cast<std::size_t>(tuning().hypotheses), groups.size());
         ++tries) {
      std::vector<Node> other = start;
      Consensus consensus = attempt(other, groups[tries]);
      if (!is_better(consensus, other, best, nodes)) continue;
      iterations_ += best.solved.iterations;
      best = std::move(consensus);
      nodes = std::move(other);
    }
  }

  // With the loops known, the start no longer matters.
  void try_free_start(std::vector<Node>& nodes, Consensus& best) {
    std::vector<Edge> kept;
    for (std::size_t e = 0; e < graph_.edges.size(); ++e) {
      if (best.weights[e] == 0.0) continue;
      kept.push_back(graph_.edges[e]);
      pose_graph::weigh(best.weights[e], kept.back());
    }
    std::vector<Node> other = nodes;
    const SolveResult solved =
        pose_graph::solve_batch(kept, other, Start::automatic, limits_, graph_.workers);
    iterations_ += solved.iterations;
    if (!is_done(solved.outcome) || solved.cost >= best.solved.cost * (1.0 - kRounding)) return;
    Consensus consensus = consensus_from(best.weights, other);
    if (!is_better(consensus, other, best, nodes)) return;
    best = std::move(consensus);
    nodes = std::move(other);
  }

  bool is_better(const Consensus& a, const std::vector<Node>& a_nodes, const Consensus& b,
                 const std::vector<Node>& b_nodes) const {
    if (!is_done(a.solved.outcome)) return false;
    const SquaredScales& scales = b.squared_scales;
    return !is_done(b.solved.outcome) || truncated_cost(graph_, a.weights, a_nodes, scales) <
                                             truncated_cost(graph_, b.weights, b_nodes, scales);
  }

  double chi2_of(std::size_t e, std::span<const Node> nodes) const {
    const Edge& edge = graph_.edges[e];
    return linearise_edge(edge, nodes).cost;
  }

  std::vector<double> weights_at(std::span<const Node> nodes, const RobustLoss& loss) const {
    std::vector<double> weights(graph_.edges.size(), 1.0);
    for (std::size_t e = 0; e < weights.size(); ++e) {
      if (graph_.is_loop[e] != 0)
        weights[e] = loss.of_rank(graph_.rank(e)).weight(chi2_of(e, nodes));
    }
    return weights;
  }

  LoopGraph graph_;
  RobustOptions options_;
  SolveLimits limits_;
  sparse::Symbolic symbolic_;
  NormalEquations equations_;
  int iterations_ = 0;
};

}  // namespace

RobustResult solve_robust(const LoopGraph& graph, std::vector<Node>& nodes,
                          const RobustOptions& options, const SolveLimits& limits,
                          std::span<const double> known) {
  std::vector<Node> result_nodes = nodes;
  RobustBatch batch(graph, options, limits, nodes.size());
  RobustResult result = options.loss.kind() == LossKind::truncated
                            ? batch.agree(result_nodes, known)
                            : batch.descend(result_nodes, known.empty());
  if (is_done(result.solved.outcome)) nodes = std::move(result_nodes);
  return result;
}

}  // namespace fathom::sparse_gauss_newton
