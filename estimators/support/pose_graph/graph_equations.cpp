#include "estimators/support/pose_graph/graph_equations.hpp"

#include <utility>

namespace fathom::pose_graph {
namespace {

template <class Equations>
bool take_step(Equations& equations, std::vector<Node>& nodes) {
  equations.linearise(nodes, Hessian::measured);
  if (!equations.factorise()) return false;
  equations.solve_step();
  equations.move(nodes, nodes);
  return true;
}

}  // namespace

void GraphEquations::eliminate_chains(const ChainGraph& chains, GraphEquations& left) {
  chain_graph_ = &chains;
  chains_.emplace(chains, left.whole().equations);
}

WholeEquations& GraphEquations::whole() {
  if (!whole_) whole_ = std::make_unique<WholeEquations>(edges_, nodes_, workers_);
  return *whole_;
}

SolveResult GraphEquations::minimise_from(std::vector<Node>& nodes, const SolveLimits& limits,
                                          Hessian first) {
  int iterations = 0;
  if (chains_) {
    std::vector<Node> moved = nodes;
    chain_graph_->follow_open_chain(moved);
    const SolveResult result = minimise(*chains_, moved, limits, first);
    if (is_done(result.outcome)) {
      nodes = std::move(moved);
      return result;
    }
    iterations = result.iterations;
  }
  SolveResult result = minimise(whole().equations, nodes, limits, {}, first);
  result.iterations += iterations;
  return result;
}

void GraphEquations::take_measured_step(std::vector<Node>& nodes) {
  if (chains_ && take_step(*chains_, nodes)) return;
  take_step(whole().equations, nodes);
}

}  // namespace fathom::pose_graph
