#include "estimators/support/pose_graph/wide.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Eigenvalues>

#include "fathom/geometry/covariance.hpp"

namespace fathom::pose_graph {
namespace {

// Of the largest information to the least, a start is computed with: half of all digits.
constexpr double kStartSpread = 1e8;
constexpr int kMostHalvings = 30;
// Of a step, as a share. Steps along what strong measurements leave open are small long before.
constexpr double kRoundingStep = 1e-14;

double largest_information(const Edge& edge) {
  return std::max({edge.W[0], edge.W[3], edge.W[5]});
}

// Along axes of its own: in those of the keyframe a fix of one turned axis has next to nothing.
double least_information(const Edge& edge) {
  const InformationRows rows = rows_of(full(edge.W));
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < rows.rank; ++i) {
    least = std::min(least, rows.rows.row(i).squaredNorm() / rows.variances(i));
  }
  return least;
}

std::vector<Edge> cut_down(std::span<const Edge> edges) {
  double least = std::numeric_limits<double>::infinity();
  for (const Edge& edge : edges) least = std::min(least, least_information(edge));
  std::vector<Edge> cut(edges.begin(), edges.end());
  for (Edge& edge : cut) {
    if (largest_information(edge) <= kStartSpread * least) continue;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(full(edge.W));
    const Eigen::Vector3d kept = solver.eigenvalues().cwiseMax(0.0).cwiseMin(kStartSpread * least);
    const Eigen::Matrix3d& axes = solver.eigenvectors();
    const Eigen::Matrix3d W = axes * kept.asDiagonal() * axes.transpose();
    edge.W = {W(0, 0), W(0, 1), W(0, 2), W(1, 1), W(1, 2), W(2, 2)};
    edge.rows = nullptr;
  }
  return cut;
}

// Of F, in squared sigmas, by rounding of the coordinates.
double rounding_of(std::span<const Edge> edges, std::span<const Node> nodes) {
  constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
  double size = std::numbers::pi;
  for (const Node& node : nodes) size = std::max({size, std::abs(node.x), std::abs(node.y)});
  double information = 0.0;
  for (const Edge& edge : edges) information += largest_information(edge);
  return information * kEpsilon * kEpsilon * size * size;
}

class WideMinimiser {
 public:
  WideMinimiser(std::span<const Edge> edges, std::vector<Node>& nodes, const SolveLimits& limits,
                Workers* workers)
      : symbolic_(analyse_graph(edges, static_cast<int>(nodes.size()), workers)),
        equations_(symbolic_, edges),
        nodes_(nodes),
        limits_(limits) {}

  SolveResult run() {
    result_.outcome = Outcome::iteration_limit;
    result_.cost = whitened_cost(equations_.edges(), nodes_);
    while (result_.iterations < limits_.max_iterations) {
      ++result_.iterations;
      if (!take_step()) break;
    }
    equations_.differentiate(nodes_);
    result_.gradient_norm = equations_.gradient_norm();
    return result_;
  }

 private:
  // False where the solve has ended.
  bool take_step() {
    const std::optional<double> promised = equations_.solve_rows(nodes_);
    if (!promised || !std::isfinite(*promised)) return end(Outcome::numerical_failure);
    const double rounding = rounding_of(equations_.edges(), nodes_);
    const bool is_last = *promised <= std::max(limits_.tolerance * result_.cost, rounding) ||
                         equations_.step_is_small(nodes_, kRoundingStep);
    for (int halvings = 0; halvings <= kMostHalvings; ++halvings) {
      equations_.move(nodes_, trial_);
      const double cost = whitened_cost(equations_.edges(), trial_);
      if (cost <= result_.cost * (1.0 + tuning_.rounding_share) + rounding) {
        nodes_.swap(trial_);
        result_.cost = cost;
        return is_last ? end(Outcome::converged) : true;
      }
      equations_.halve_step();
    }
    return end(is_last ? Outcome::converged : Outcome::numerical_failure);
  }

  bool end(Outcome outcome) {
    result_.outcome = outcome;
    return false;
  }

  sparse::Symbolic symbolic_;
  NormalEquations equations_;
  std::vector<Node>& nodes_;
  std::vector<Node> trial_;
  SolveLimits limits_;
  SolverTuning tuning_;
  SolveResult result_;
};

}  // namespace

bool sums_keep_digits(std::span<const Edge> edges, std::span<const Node> nodes) {
  const sparse::Symbolic symbolic = analyse_graph(edges, static_cast<int>(nodes.size()));
  return NormalEquations(symbolic, edges).factorise_at(nodes);
}

SolveResult solve_wide(std::span<const Edge> edges, std::vector<Node>& nodes, Start start,
                       const SolveLimits& limits, Workers* workers) {
  std::vector<Node> result_nodes = nodes;
  const SolveResult started = solve_batch(cut_down(edges), result_nodes, start, limits, workers);
  SolveResult result = WideMinimiser(edges, result_nodes, limits, workers).run();
  result.iterations += started.iterations;
  if (result.outcome != Outcome::converged) {
    std::vector<Node> other = nodes;
    SolveResult direct = WideMinimiser(edges, other, limits, workers).run();
    direct.iterations += result.iterations;
    result.iterations = direct.iterations;
    if (is_done(direct.outcome) && !(is_done(result.outcome) && result.cost < direct.cost)) {
      result = direct;
      result_nodes = std::move(other);
    }
  }
  if (is_done(result.outcome)) nodes = std::move(result_nodes);
  return result;
}

}  // namespace fathom::pose_graph
