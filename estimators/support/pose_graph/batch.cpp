#include "estimators/support/pose_graph/batch.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "estimators/support/pose_graph/chain_turns.hpp"
#include "estimators/support/pose_graph/chordal.hpp"
#include "estimators/support/pose_graph/graph_equations.hpp"
#include "estimators/support/pose_graph/headings.hpp"
#include "estimators/support/pose_graph/lifted_headings.hpp"
#include "estimators/support/pose_graph/turn_graph.hpp"

namespace fathom::pose_graph {
namespace {

class Batch {
 public:
  Batch(std::span<const Edge> edges, std::vector<Node>& nodes, const SolveLimits& limits,
        Workers* workers)
      : edges_(edges),
        nodes_(nodes),
        limits_(limits),
        keyframes_(keyframes_of(nodes)),
        workers_(workers),
        equations_(edges, nodes.size(), workers),
        chains_(edges, nodes) {
    if (!chains_.has_chains()) return;
    left_nodes_ = chains_.nodes();
    left_ = std::make_unique<Batch>(chains_.edges(), left_nodes_, limits, workers);
    equations_.eliminate_chains(chains_, left_->equations_);
  }

  SolveResult run(Start start) {
    switch (start) {
      case Start::given:
        try_from(nodes_);
        break;
      case Start::lago:
        try_from(from_headings(lago_headings()));
        break;
      case Start::chordal:
        try_from(from_headings(settled(chordal_start())));
        break;
      case Start::lifted:
        try_from(lifted());
        break;
      case Start::automatic:
        run_automatic();
        break;
    }
    best_.iterations = iterations_;
    if (is_done(best_.outcome)) nodes_ = std::move(best_nodes_);
    return best_;
  }

 private:
  // Of a graph of long chains, from the minimum of the one without them. Whether that ends the
  // search.
  bool run_without_chains() {
    if (!chains_.measure()) return false;
    if (left_nodes_.size() > 1) {
      const SolveResult solved = left_->run(Start::automatic);
      if (solved.outcome != Outcome::converged || !solved.is_local_minimum.value_or(false)) {
        return false;
      }
    }
    std::vector<Node> start = chains_.expanded(left_nodes_);
    return turns().worst_turn(headings_of(start)) < kTrustedTurnRad &&
           try_from(std::move(start), Hessian::exact);
  }

  // The headings of LAGO are judged before the positions are computed for them, and with them.
  void run_automatic() {
    if (run_without_chains()) return;
    const std::vector<double> turned = lago_headings();
    std::vector<Node> first;
    bool is_trusted = are_trusted(turned);
    if (is_trusted) {
      first = from_headings(turned);
      const std::vector<double> corrected = headings_of(first);
      is_trusted = are_trusted(corrected);
      const bool is_near = largest_turn(turned, corrected) < kNearRad;
      const Hessian hessian = is_near ? Hessian::exact : Hessian::gauss_newton;
      if (is_trusted && try_from(std::move(first), hessian)) return;
    }
    if (run_chordal()) return;
    if (try_from(lifted())) return;
    // NOLINTNEXTLINE(bugprone-use-after-move): moved from above only if it is trusted
    if (!is_trusted) try_from(first.empty() ? from_headings(turned) : std::move(first));
    try_from(nodes_);
  }

  // From chordal headings where these leave every edge's heading close to what it measured, before
  // the positions are computed for them and after.
  bool run_chordal() {
    const std::vector<double> theta = settled(chordal_start());
    if (!are_trusted(theta)) return false;
    std::vector<Node> start = from_headings(theta);
    return are_trusted(headings_of(start)) && try_from(std::move(start));
  }

  // Minimises from a start and keeps the result if it is the best so far. Whether it is good
  // enough to end the search.
  bool try_from(std::vector<Node> nodes, Hessian first = Hessian::gauss_newton) {
    const SolveResult result = equations_.minimise_from(nodes, limits_, first);
    iterations_ += result.iterations;
    const bool is_better = !tried_ || (is_done(result.outcome) &&
                                       (!is_done(best_.outcome) || result.cost < best_.cost));
    tried_ = true;
    if (!is_better) return false;
    best_ = result;
    best_nodes_ = std::move(nodes);
    return result.outcome == Outcome::converged && result.is_local_minimum.value_or(false);
  }

  const TurnGraph& turns() {
    if (!turns_) turns_.emplace(edges_, std::span<const Node>(nodes_).first(keyframes_));
    return *turns_;
  }

  // Least squares in the headings, each turn rounded along `theta`; without the keyframes of
  // chains where all edges measure their turn.
  std::vector<double> least_squares(std::span<const double> theta) {
    const ChainTurns* const chains = chain_turns();
    if (!headings_ && chains != nullptr) {
      headings_.emplace(left_->equations_.whole().symbolic, chains->edges());
    } else if (!headings_) {
      headings_.emplace(turn_pattern(), turns().edges());
    }
    return chains == nullptr ? headings_->solve(theta) : chains->solve(*headings_, theta);
  }

  // Null where there are no chains, or where an edge does not measure its turn.
  const ChainTurns* chain_turns() {
    if (left_ == nullptr || !turns().are_all()) return nullptr;
    if (!chain_turns_) chain_turns_.emplace(chains_);
    return &*chain_turns_;
  }

  // Headings know nothing of the errors of pictures.
  const sparse::Symbolic& turn_pattern() {
    if (keyframes_ == nodes_.size() && left_ == nullptr) return equations_.whole().symbolic;
    if (!turn_pattern_) {
      const std::span<const Edge> all = turns().edges();
      std::vector<Edge> apart(all.begin(), all.end());
      for (Edge& edge : apart) edge.shared = nullptr;
      turn_pattern_ = analyse_graph(apart, static_cast<int>(keyframes_), workers_);
    }
    return *turn_pattern_;
  }

  std::vector<double> lago_headings() {
    std::vector<double> theta{nodes_[0].theta};
    theta.reserve(keyframes_);
    for (std::size_t k = 1; k < keyframes_; ++k) {
      theta.push_back(theta.back() + wrap_angle(nodes_[k].theta - nodes_[k - 1].theta));
    }
    return least_squares(theta);
  }

  // What `relax` makes of a pattern and its edges, of the graph without chains where it can.
  template <class Relax>
  std::vector<double> relaxed(const Relax& relax) {
    const ChainTurns* const chains = chain_turns();
    if (chains == nullptr) return relax(turn_pattern(), turns().edges());
    return chains->between(relax(left_->equations_.whole().symbolic, chains->edges()));
  }

  std::vector<double> chordal_start() {
    return relaxed([this](const sparse::Symbolic& symbolic, std::span<const Edge> edges) {
      return chordal_ = chordal_headings(symbolic, edges, nodes_[0].theta);
    });
  }

  std::vector<Node> lifted() {
    if (chordal_.empty()) chordal_start();
    return from_headings(
        settled(relaxed([this](const sparse::Symbolic& symbolic, std::span<const Edge> edges) {
          return lifted_headings(symbolic, edges, chordal_);
        })));
  }

  // Least squares in the headings, rounded again until that changes nothing.
  std::vector<double> settled(std::vector<double> theta) {
    for (int i = 0; i < kHeadingSolves; ++i) {
      std::vector<double> next = least_squares(theta);
      const double moved = largest_turn(theta, next);
      theta = std::move(next);
      if (moved < kHeadingsSettledRad) break;
    }
    return theta;
  }

  std::vector<Node> from_headings(const std::vector<double>& theta) {
    std::vector<Node> turned = nodes_;
    for (std::size_t k = 1; k < theta.size(); ++k) {
      turned[k] = make_node(nodes_[k].x, nodes_[k].y, theta[k]);
    }
    equations_.take_measured_step(turned);
    return turned;
  }

  std::vector<double> headings_of(const std::vector<Node>& nodes) const {
    std::vector<double> theta;
    theta.reserve(keyframes_);
    for (std::size_t k = 0; k < keyframes_; ++k) theta.push_back(nodes[k].theta);
    return theta;
  }

  // Whether no multiple of 2π was rounded wrongly.
  bool are_trusted(const std::vector<double>& theta) {
    if (turns().worst_turn(theta) >= kTrustedTurnRad) return false;
    return chain_turns() == nullptr || chain_turns_->worst_turn(theta) < kTrustedChainRad;
  }

  std::span<const Edge> edges_;
  std::vector<Node>& nodes_;
  SolveLimits limits_;
  std::size_t keyframes_;
  Workers* workers_;
  GraphEquations equations_;
  ChainGraph chains_;
  std::vector<Node> left_nodes_;
  std::unique_ptr<Batch> left_;                   ///< of the graph without chains
  std::optional<sparse::Symbolic> turn_pattern_;  ///< where it is not that of the equations
  std::optional<TurnGraph> turns_;
  std::optional<ChainTurns> chain_turns_;
  std::vector<double> chordal_;  ///< of the graph that is relaxed
  std::optional<HeadingProblem> headings_;
  SolveResult best_;
  std::vector<Node> best_nodes_;
  bool tried_ = false;
  int iterations_ = 0;
};

}  // namespace

SolveResult solve_batch(std::span<const Edge> edges, std::vector<Node>& nodes, Start start,
                        const SolveLimits& limits, Workers* workers) {
  return Batch(edges, nodes, limits, workers).run(start);
}

}  // namespace fathom::pose_graph
