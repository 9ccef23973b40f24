#include "estimators/support/pose_graph/chain_turns.hpp"

#include "fathom/geometry/pose.hpp"

namespace fathom::pose_graph {

ChainTurns::ChainTurns(const ChainGraph& chains)
    : chains_(chains), edges_(chains.edges().begin(), chains.edges().end()) {
  for (std::size_t i = 0; i < chains.chains().size(); ++i) {
    const ChainGraph::Chain& chain = chains.chains()[i];
    double turn = 0.0;
    double variance = 0.0;
    for (int t = 0; t < chain.count; ++t) {
      turn += chains.step(chain, t).theta;
      variance += 1.0 / heading_information(chains.step(chain, t));
    }
    variances_.push_back(variance);
    if (chain.is_open || chain.count == 1) continue;
    edges_[i].theta = turn;
    edges_[i].W = {1.0, 0.0, 0.0, 1.0, 0.0, 1.0 / variance};
  }
}

std::vector<double> ChainTurns::left(std::span<const double> theta) const {
  std::vector<double> left;
  for (const ChainGraph::Chain& chain : chains_.chains()) left.push_back(theta[at(chain.begin)]);
  if (left.size() < chains_.nodes().size()) left.push_back(theta.back());
  return left;
}

// What the end of a chain lacks is distributed by the variances.
std::vector<double> ChainTurns::expanded(std::span<const double> theta) const {
  std::vector<double> all{theta[0]};
  for (std::size_t i = 0; i < chains_.chains().size(); ++i) {
    const ChainGraph::Chain& chain = chains_.chains()[i];
    double lacks = 0.0;
    if (!chain.is_open) lacks = wrap_angle(theta[i + 1] - theta[i] - edges_[i].theta);
    double turned = theta[i];
    for (int t = 0; t < chain.count; ++t) {
      const Edge& step = chains_.step(chain, t);
      turned += step.theta + lacks / (variances_[i] * heading_information(step));
      all.push_back(turned);
    }
    if (!chain.is_open) all.back() = theta[i + 1];
  }
  return all;
}

}  // namespace fathom::pose_graph
