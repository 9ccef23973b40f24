#include "estimators/sparse_gauss_newton/candidates.hpp"

#include <utility>

#include "estimators/sparse_gauss_newton/leave_one_out.hpp"
#include "estimators/sparse_gauss_newton/loop_groups.hpp"

namespace fathom::sparse_gauss_newton {
namespace {

template <class T>
std::vector<T> pick(std::span<const T> all, const std::vector<std::size_t>& indices) {
  std::vector<T> part;
  part.reserve(indices.size());
  for (const std::size_t e : indices) part.push_back(all[e]);
  return part;
}

}  // namespace

Candidates::Candidates(const LoopGraph& graph, std::vector<std::size_t> edges,
                       std::size_t keyframes)
    : indices_(std::move(edges)),
      edges_(pick(graph.edges, indices_)),
      is_loop_(pick(graph.is_loop, indices_)),
      ranks_(graph.ranks.empty() ? std::vector<char>() : pick(graph.ranks, indices_)),
      symbolic_(analyse_graph(edges_, static_cast<int>(keyframes), graph.workers)),
      equations_(symbolic_, edges_) {}

SolveResult Candidates::solve(std::vector<Node>& nodes, std::span<const double> weights,
                              const SolveLimits& limits) {
  equations_.set_loss({RobustLoss(), {}, weights});
  return minimise(equations_, nodes, limits);
}

std::vector<double> Candidates::leave_one_out(std::span<const double> weights,
                                              std::span<const Node> nodes) {
  return sparse_gauss_newton::leave_one_out(equations_, {edges_, is_loop_, ranks_}, weights, nodes);
}

std::vector<std::vector<std::size_t>> Candidates::groups(std::span<const double> weights,
                                                         int reach) const {
  std::vector<std::size_t> kept;
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    if (is_registration(e) && weights[e] > 0.0) kept.push_back(e);
  }
  const auto any = [](const Edge&, const Edge&) { return true; };
  return group_loops(edges_, std::move(kept), reach, any);
}

double Candidates::group_chi2(const std::vector<std::size_t>& group,
                              std::span<const double> weights, std::span<const Node> nodes) {
  return sparse_gauss_newton::group_chi2(equations_, group, weights, nodes);
}

}  // namespace fathom::sparse_gauss_newton
