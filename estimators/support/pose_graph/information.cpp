#include "estimators/support/pose_graph/information.hpp"

#include "estimators/support/pose_graph/normal_equations.hpp"
#include "estimators/support/sparse/selected_inverse.hpp"
#include "fathom/estimation/joint_covariance.hpp"

namespace fathom::pose_graph {
namespace {

// The factor of the Gauss-Newton matrix at an estimate.
class Information {
 public:
  Information(std::span<const Edge> edges, std::span<const Node> nodes)
      : symbolic_(analyse_graph(edges, static_cast<int>(nodes.size()))),
        equations_(symbolic_, edges) {
    is_definite_ = equations_.factorise_at(nodes) || equations_.solve_rows(nodes).has_value();
  }

  bool is_definite() const { return is_definite_; }
  sparse::BlockCholesky<3>& factor() { return equations_.factor(); }

  /// The three columns of the covariance that belong to a keyframe other than 0.
  Eigen::MatrixX3d columns(std::size_t keyframe) {
    Eigen::MatrixX3d result = Eigen::MatrixX3d::Zero(3 * Eigen::Index{symbolic_.size()}, 3);
    const Eigen::Index row = row_of(keyframe);
    for (int j = 0; j < 3; ++j) {
      result(row + j, j) = 1.0;
      equations_.solve(result.col(j).data());
    }
    return result;
  }

  Eigen::Matrix3d block(const Eigen::MatrixX3d& columns, std::size_t keyframe) const {
    return columns.middleRows<3>(row_of(keyframe));
  }

 private:
  Eigen::Index row_of(std::size_t keyframe) const {
    return 3 * Eigen::Index{symbolic_.position[keyframe - 1]};
  }

  sparse::Symbolic symbolic_;
  NormalEquations equations_;
  bool is_definite_ = false;
};

}  // namespace

std::optional<std::vector<Eigen::Matrix3d>> marginals(std::span<const Edge> edges,
                                                      std::span<const Node> nodes) {
  Information information(edges, nodes);
  if (!information.is_definite()) return std::nullopt;
  const auto inverse = sparse::SelectedInverse::in_place_of(information.factor());
  std::vector<Eigen::Matrix3d> result{Eigen::Matrix3d::Zero()};
  const std::size_t keyframes = keyframes_of(nodes);
  result.reserve(keyframes);
  for (int node = 0; node + 1 < static_cast<int>(keyframes); ++node) {
    result.push_back(inverse.block(node));
  }
  return result;
}

std::optional<Eigen::MatrixXd> joint_covariance(std::span<const Edge> edges,
                                                std::span<const Node> nodes,
                                                std::span<const std::size_t> keyframes) {
  Information information(edges, nodes);
  if (!information.is_definite()) return std::nullopt;
  const std::vector<std::size_t> free = free_keyframes(keyframes);
  const auto size = static_cast<Eigen::Index>(3 * free.size());
  Eigen::MatrixXd joint(size, size);
  for (std::size_t j = 0; j < free.size(); ++j) {
    const Eigen::MatrixX3d columns = information.columns(free[j]);
    for (std::size_t i = 0; i <= j; ++i) {
      joint.block<3, 3>(static_cast<Eigen::Index>(3 * i), static_cast<Eigen::Index>(3 * j)) =
          information.block(columns, free[i]);
    }
  }
  return in_order_of(keyframes, joint);
}

std::optional<std::vector<UncertainPose>> motions_to_newest(std::span<const Edge> edges,
                                                            std::span<const Node> nodes) {
  std::vector<UncertainPose> motions;
  const std::size_t newest = keyframes_of(nodes) - 1;
  if (newest == 0) return motions;
  Information information(edges, nodes);
  if (!information.is_definite()) return std::nullopt;
  const Eigen::MatrixX3d to_newest = information.columns(newest);
  const auto inverse = sparse::SelectedInverse::in_place_of(information.factor());
  PairCovariance pair;
  pair.B = information.block(to_newest, newest);
  for (std::size_t k = 0; k < newest; ++k) {
    if (k > 0) {
      pair.A = inverse.block(static_cast<int>(k) - 1);
      pair.cross = information.block(to_newest, k);
    }
    motions.push_back(between(pose_of(nodes[k]), pose_of(nodes[newest]), pair));
  }
  return motions;
}

std::optional<std::vector<Eigen::Matrix3d>> predicted_covariances(
    std::span<const Edge> edges, std::span<const Node> nodes,
    std::span<const RelativePose> forward_loops) {
  Information information(edges, nodes);
  if (!information.is_definite()) return std::nullopt;
  const std::size_t newest = keyframes_of(nodes) - 1;
  const Eigen::MatrixX3d to_newest = information.columns(newest);
  std::vector<Eigen::Matrix3d> predicted;
  for (const RelativePose& z : forward_loops) {
    PairCovariance pair;
    pair.B = information.block(to_newest, newest);
    if (z.from > 0) {
      pair.A = information.block(information.columns(z.from), z.from);
      pair.cross = information.block(to_newest, z.from);
    }
    const UncertainPose h = between(pose_of(nodes[z.from]), pose_of(nodes[z.to]), pair);
    predicted.push_back(h.covariance);
  }
  return predicted;
}

std::optional<std::vector<Eigen::Matrix3d>> predicted_shared_covariances(
    const ExtendedGraph& graph, std::span<const RelativePose> forward_loops) {
  Information information(graph.edges, graph.nodes);
  if (!information.is_definite()) return std::nullopt;
  std::vector<Eigen::Matrix3d> predicted;
  for (const RelativePose& z : forward_loops) {
    Eigen::Matrix3d S = Eigen::Matrix3d::Zero();
    std::vector<std::pair<std::size_t, Eigen::Matrix3d>> terms(2);
    between(pose_of(graph.nodes[z.from]), pose_of(graph.nodes[z.to]), &terms[0].second,
            &terms[1].second);
    terms[0].first = z.from;
    terms[1].first = z.to;
    const auto add_errors = [&](std::size_t keyframe, const Eigen::Matrix3d& G) {
      const int node = keyframe < graph.node_of.size() ? graph.node_of[keyframe] : -1;
      if (node < 0) {
        S += G * G.transpose();
      } else {
        terms.emplace_back(at(node), G);
      }
    };
    if (z.shared) {
      add_errors(z.from, z.shared->from.scaled());
      add_errors(z.to, z.shared->to.scaled());
    }
    for (const auto& [node, J] : terms) {
      if (node == 0) continue;
      const Eigen::MatrixX3d columns = information.columns(node);
      for (const auto& [other, H] : terms) {
        if (other > 0) S += H * information.block(columns, other) * J.transpose();
      }
    }
    predicted.push_back(0.5 * (S + S.transpose()));
  }
  return predicted;
}

}  // namespace fathom::pose_graph
