#include "estimators/support/pose_graph/minimum_search.hpp"

#include <algorithm>
#include <utility>

#include "estimators/support/pose_graph/batch.hpp"
#include "fathom/core/chi_squared.hpp"

namespace fathom::pose_graph {
namespace {

constexpr double kChanceOfRise = 1e-4;

// What registrations count on the way, and how near to the minimum each stage goes.
constexpr double kWeights[] = {1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1};
constexpr double kStageTolerance = 1e-3;

bool is_step(const Edge& edge) {
  return edge.to == edge.from + 1;
}

// By the steps; where there is none a keyframe keeps its motion from the one before.
std::vector<Node> dead_reckoned(std::span<const Edge> edges, const std::vector<Node>& nodes) {
  const std::size_t keyframes = keyframes_of(nodes);
  std::vector<Pose> motions;
  for (std::size_t k = 1; k < keyframes; ++k) {
    motions.push_back(between(pose_of(nodes[k - 1]), pose_of(nodes[k])));
  }
  // Of several the first, which is the step: others may measure less than a motion.
  for (std::size_t e = edges.size(); e-- > 0;) {
    const Edge& edge = edges[e];
    if (!is_step(edge) || static_cast<std::size_t>(edge.to) >= keyframes) continue;
    motions[static_cast<std::size_t>(edge.from)] = {edge.x, edge.y, edge.theta};
  }
  std::vector<Node> reckoned = nodes;
  Pose pose = pose_of(nodes[0]);
  for (std::size_t k = 1; k < keyframes; ++k) {
    pose = compose(pose, motions[k - 1]);
    reckoned[k] = make_node(pose.x, pose.y, pose.theta);
  }
  return reckoned;
}

}  // namespace

SolveResult solve_graduated(std::span<const Edge> edges, std::vector<Node>& nodes,
                            const SolveLimits& limits, Workers* workers) {
  std::vector<Node> at = dead_reckoned(edges, nodes);
  int iterations = 0;
  for (const double weight : kWeights) {
    std::vector<Edge> weighted(edges.begin(), edges.end());
    for (Edge& edge : weighted) {
      if (!is_step(edge)) weigh(weight, edge);
    }
    iterations +=
        solve_batch(weighted, at, Start::given, {limits.max_iterations, kStageTolerance}, workers)
            .iterations;
  }
  SolveResult result = solve_batch(edges, at, Start::given, limits, workers);
  result.iterations += iterations;
  if (is_done(result.outcome)) nodes = std::move(at);
  return result;
}

bool MinimumSearch::is_due(double before, double after, std::size_t registrations) {
  const double per_degree = registrations_ > 0.0 ? before / (3.0 * registrations_) : 0.0;
  registrations_ += static_cast<double>(registrations);
  const double dof = 3.0 * static_cast<double>(registrations);
  const double rise = (after - before) / std::max(1.0, per_degree);
  if (!(rise > dof) || !(rise > chi_squared_quantile(1.0 - kChanceOfRise, dof))) return false;
  if (left_out_ < to_leave_out_) {
    ++left_out_;
    return false;
  }
  left_out_ = 0;
  return true;
}

std::optional<SolveResult> MinimumSearch::run(std::span<const Edge> edges, std::vector<Node>& nodes,
                                              double cost, const SolveLimits& limits,
                                              Workers* workers) {
  std::vector<Node> other = nodes;
  SolveResult best = solve_batch(edges, other, Start::automatic, limits, workers);
  std::vector<Node> last = nodes;
  const SolveResult graduated = solve_graduated(edges, last, limits, workers);
  const int iterations = best.iterations + graduated.iterations;
  if (is_done(graduated.outcome) && (!is_done(best.outcome) || graduated.cost < best.cost)) {
    best = graduated;
    other.swap(last);
  }
  best.iterations = iterations;
  const bool is_lower = is_done(best.outcome) && best.cost < cost * (1.0 - limits.tolerance);
  to_leave_out_ = is_lower ? 0 : 4 * to_leave_out_ + 3;
  if (!is_lower) return std::nullopt;
  nodes = std::move(other);
  return best;
}

}  // namespace fathom::pose_graph
