#include "estimators/sparse_gauss_newton/graph.hpp"

#include <utility>

#include "estimators/sparse_gauss_newton/selected_inverse.hpp"
#include "fathom/geometry/covariance.hpp"

namespace fathom::sparse_gauss_newton {
namespace {

// The factor of the Gauss-Newton matrix at an estimate.
class Information {
 public:
  Information(std::vector<Edge> edges, std::span<const Node> nodes)
      : edges_(std::move(edges)),
        symbolic_(analyse_graph(edges_, static_cast<int>(nodes.size()))),
        equations_(symbolic_, edges_) {
    equations_.linearise(nodes, Hessian::gauss_newton);
    is_definite_ = equations_.factorise() && equations_.negative_pivots() == 0;
  }

  bool is_definite() const { return is_definite_; }
  const BlockCholesky<3>& factor() const { return equations_.factor(); }

  /// The three columns of the covariance that belong to a keyframe other than 0.
  Eigen::MatrixX3d columns(std::size_t keyframe) {
    Eigen::MatrixX3d result = Eigen::MatrixX3d::Zero(3 * symbolic_.size(), 3);
    const int row = 3 * symbolic_.position[keyframe - 1];
    for (int j = 0; j < 3; ++j) {
      result(row + j, j) = 1.0;
      equations_.solve(result.col(j).data());
    }
    return result;
  }

  Eigen::Matrix3d block(const Eigen::MatrixX3d& columns, std::size_t keyframe) const {
    return columns.middleRows<3>(3 * symbolic_.position[keyframe - 1]);
  }

 private:
  std::vector<Edge> edges_;
  Symbolic symbolic_;
  NormalEquations equations_;
  bool is_definite_ = false;
};

}  // namespace

Graph::Graph(const Pose& origin, const RobustOptions& robust)
    : robust_(robust), nodes_{make_node(origin.x, origin.y, origin.theta)} {}

Pose Graph::pose(std::size_t k) const {
  return {nodes_[k].x, nodes_[k].y, wrap_angle(nodes_[k].theta)};
}

void Graph::set_poses(std::span<const Pose> poses) {
  for (std::size_t k = 1; k < nodes_.size(); ++k) {
    nodes_[k] = make_node(poses[k].x, poses[k].y, poses[k].theta);
  }
  changed();
}

void Graph::add_keyframe(const RelativePose& step) {
  const Pose next = compose(pose(size() - 1), step.forward().motion);
  nodes_.push_back(make_node(next.x, next.y, next.theta));
  edges_.push_back(make_edge(step));
  is_loop_.push_back(0);
  weights_.push_back(1.0);
  changed();
}

void Graph::add_registration(const RelativePose& registration) {
  edges_.push_back(make_edge(registration));
  is_loop_.push_back(1);
  weights_.push_back(1.0);
  changed();
}

void Graph::forget_edges(std::size_t count) {
  edges_.resize(count);
  is_loop_.resize(count);
  weights_.resize(count);
  changed();
}

SolveResult Graph::solve(Start start, const SolveLimits& limits) {
  changed();
  return solve_batch(edges_, nodes_, start, limits);
}

SolveResult Graph::solve_robust(const SolveLimits& limits, bool from_scratch) {
  changed();
  std::vector<double> known;
  if (!from_scratch) {
    known = weights_;
    for (std::size_t e = judged_; e < known.size(); ++e)
      known[e] = is_loop_[e] != 0 ? kNewLoop : 1.0;
  }
  RobustResult result =
      sparse_gauss_newton::solve_robust({edges_, is_loop_}, nodes_, robust_, limits, known);
  if (is_done(result.solved.outcome)) {
    weights_ = std::move(result.weights);
    judged_ = edges_.size();
  }
  return result.solved;
}

std::vector<double> Graph::registration_weights() const {
  std::vector<double> weights;
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    if (is_loop_[e] != 0) weights.push_back(weights_[e]);
  }
  return weights;
}

std::vector<Edge> Graph::weighted_edges() const {
  std::vector<Edge> edges;
  edges.reserve(edges_.size());
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    if (weights_[e] == 0.0) continue;
    edges.push_back(edges_[e]);
    for (double& element : edges.back().W) element *= weights_[e];
  }
  return edges;
}

void Graph::compute_marginals() {
  marginals_.emplace();
  marginals_->reserve(size());
  Information information(weighted_edges(), nodes_);
  if (!information.is_definite()) return;
  const SelectedInverse inverse(information.factor());
  marginals_->push_back(Eigen::Matrix3d::Zero());
  for (int node = 0; node + 1 < static_cast<int>(size()); ++node) {
    marginals_->push_back(inverse.block(node));
  }
}

std::optional<Eigen::Matrix3d> Graph::marginal(std::size_t k) {
  if (!marginals_) compute_marginals();
  if (marginals_->empty()) return std::nullopt;
  return (*marginals_)[k];
}

std::optional<std::vector<UncertainPose>> Graph::motions_to_newest() const {
  std::vector<UncertainPose> motions;
  const std::size_t newest = size() - 1;
  if (newest == 0) return motions;
  Information information(weighted_edges(), nodes_);
  if (!information.is_definite()) return std::nullopt;
  const SelectedInverse inverse(information.factor());
  const Eigen::MatrixX3d to_newest = information.columns(newest);
  for (std::size_t k = 0; k < newest; ++k) {
    Eigen::Matrix3d H_k;
    Eigen::Matrix3d H_newest;
    const Pose motion = between(pose(k), pose(newest), &H_k, &H_newest);
    Eigen::Matrix3d covariance = transport(H_newest, information.block(to_newest, newest));
    if (k > 0) {
      const Eigen::Matrix3d own = inverse.block(static_cast<int>(k) - 1);
      const Eigen::Matrix3d cross = H_k * information.block(to_newest, k) * H_newest.transpose();
      covariance += transport(H_k, own) + cross + cross.transpose();
    }
    motions.push_back({motion, covariance});
  }
  return motions;
}

std::optional<std::vector<Eigen::Matrix3d>> Graph::innovation_covariances(
    std::span<const RelativePose> forward_loops) const {
  Information information(weighted_edges(), nodes_);
  if (!information.is_definite()) return std::nullopt;
  const std::size_t newest = size() - 1;
  const Eigen::MatrixX3d to_newest = information.columns(newest);
  std::vector<Eigen::Matrix3d> innovations;
  for (const RelativePose& z : forward_loops) {
    Eigen::Matrix3d H_from;
    Eigen::Matrix3d H_to;
    between(pose(z.from), pose(z.to), &H_from, &H_to);
    Eigen::Matrix3d S = transport(H_to, information.block(to_newest, newest)) + z.covariance();
    if (z.from > 0) {
      const Eigen::Matrix3d own = information.block(information.columns(z.from), z.from);
      const Eigen::Matrix3d cross =
          H_from * information.block(to_newest, z.from) * H_to.transpose();
      S += transport(H_from, own) + cross + cross.transpose();
    }
    innovations.push_back(S);
  }
  return innovations;
}

}  // namespace fathom::sparse_gauss_newton
