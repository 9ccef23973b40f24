#include "estimators/support/pose_graph/graph_equations.hpp"

namespace fathom::pose_graph {
namespace {

template <class Equations>
void take_step(Equations& equations, std::vector<Node>& nodes) {
  equations.linearise(nodes, Hessian::measured);
  if (!equations.factorise()) return;
  equations.solve_step();
  equations.move(nodes, nodes);
}

}  // namespace

void GraphEquations::eliminate_chains(const ChainGraph& chains, GraphEquations& left) {
  chain_graph_ = &chains;
  chains_.emplace(chains, left.whole().equations, workers_);
}

WholeEquations& GraphEquations::whole() {
  if (!whole_) whole_ = std::make_unique<WholeEquations>(edges_, nodes_, workers_);
  return *whole_;
}

SolveResult GraphEquations::minimise_from(std::vector<Node>& nodes, const SolveLimits& limits,
                                          Hessian first) {
  if (!chains_) return minimise(whole().equations, nodes, limits, {}, first);
  chain_graph_->follow_open_chain(nodes);
  return minimise(*chains_, nodes, limits, first);
}

void GraphEquations::take_measured_step(std::vector<Node>& nodes) {
  chains_ ? take_step(*chains_, nodes) : take_step(whole().equations, nodes);
}

}  // namespace fathom::pose_graph
