#include "estimators/support/pose_graph/chain_turns.hpp"

#include <algorithm>
#include <cmath>

#include "fathom/geometry/pose.hpp"

namespace fathom::pose_graph {

ChainTurns::ChainTurns(const ChainGraph& chains)
    : chains_(chains), edges_(chains.edges().begin(), chains.edges().end()) {
  for (std::size_t i = 0; i < chains.chains().size(); ++i) {
    const ChainGraph::Chain& chain = chains.chains()[i];
    double variance = 0.0;
    double turn = 0.0;
    for (int t = 0; t < chain.count; ++t) {
      variance += 1.0 / heading_information(chains.step(chain, t));
      turn += chains.step(chain, t).theta;
    }
    variances_.push_back(variance);
    if (chain.is_open) continue;
    edges_[i].theta = turn;
    edges_[i].W = {1.0, 0.0, 0.0, 1.0, 0.0, 1.0 / variance};
  }
}

std::vector<double> ChainTurns::solve(HeadingProblem& left, std::span<const double> theta) const {
  const auto residual = [&](const ChainGraph::Chain& chain, int t) {
    const std::size_t k = at(chain.begin + t);
    return wrap_angle(chains_.step(chain, t).theta - theta[k + 1] + theta[k]);
  };
  std::vector<double> at_ends;
  std::vector<double> residuals;
  for (const ChainGraph::Chain& chain : chains_.chains()) {
    at_ends.push_back(theta[at(chain.begin)]);
    if (chain.is_open) continue;
    residuals.push_back(0.0);
    for (int t = 0; t < chain.count; ++t) residuals.back() += residual(chain, t);
  }
  if (at_ends.size() < chains_.nodes().size()) at_ends.push_back(theta.back());
  const std::vector<double> solved = left.solve(at_ends, residuals);

  std::vector<double> all{solved[0]};
  for (std::size_t i = 0; i < chains_.chains().size(); ++i) {
    const ChainGraph::Chain& chain = chains_.chains()[i];
    // What is left of the residual of a chain is distributed by the variances.
    double remains = 0.0;
    if (!chain.is_open) {
      remains = residuals[i] - ((solved[i + 1] - solved[i]) - (at_ends[i + 1] - at_ends[i]));
    }
    double turned = solved[i];
    for (int t = 0; t < chain.count; ++t) {
      const std::size_t k = at(chain.begin + t);
      const double share = 1.0 / (variances_[i] * heading_information(chains_.step(chain, t)));
      turned += theta[k + 1] - theta[k] + residual(chain, t) - share * remains;
      all.push_back(turned);
    }
    if (!chain.is_open) all.back() = solved[i + 1];
  }
  return all;
}

double ChainTurns::worst_turn(std::span<const double> theta) const {
  double worst = 0.0;
  for (const ChainGraph::Chain& chain : chains_.chains()) {
    double sum = 0.0;
    for (int t = 0; t < chain.count; ++t) {
      const std::size_t k = at(chain.begin + t);
      sum += wrap_angle(chains_.step(chain, t).theta - theta[k + 1] + theta[k]);
    }
    worst = std::max(worst, std::abs(sum));
  }
  return worst;
}

std::vector<double> ChainTurns::between(std::span<const double> left) const {
  double turned = left[0];
  std::vector<double> all{turned};
  for (std::size_t i = 0; i < chains_.chains().size(); ++i) {
    const ChainGraph::Chain& chain = chains_.chains()[i];
    const double off = chain.is_open ? 0.0 : wrap_angle(left[i + 1] - left[i] - edges_[i].theta);
    for (int t = 0; t < chain.count; ++t) {
      const Edge& step = chains_.step(chain, t);
      turned += step.theta + off / (variances_[i] * heading_information(step));
      all.push_back(turned);
    }
  }
  return all;
}

}  // namespace fathom::pose_graph
