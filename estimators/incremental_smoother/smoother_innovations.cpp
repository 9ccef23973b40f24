// What a Smoother's tree says of uncertainty, or the whole graph where there is no tree.

#include <algorithm>

#include "estimators/incremental_smoother/smoother.hpp"
#include "estimators/support/pose_graph/information.hpp"

namespace fathom::incremental_smoother {

std::optional<std::vector<Eigen::Matrix3d>> Smoother::predicted_covariances(
    std::span<const RelativePose> forward_loops) {
  std::vector<Eigen::Matrix3d> result;
  for (const RelativePose& z : forward_loops) {
    const auto S =
        has_states(z) ? shared_covariance(z) : motion_covariance(static_cast<int>(z.from));
    if (!S) return std::nullopt;
    result.push_back(*S);
  }
  return result;
}

// The origin is exact, so the motion from it is all that is uncertain.
std::optional<Eigen::Matrix3d> Smoother::newest_covariance() {
  if (!has_tree()) return std::nullopt;
  return transport(planar_rotation(problem_.nodes[0].theta), *motion_covariance(0));
}

// Poses of the graph are in world axes.
std::optional<Eigen::Matrix3d> Smoother::variance(
    const std::vector<CliqueTree::Response>& responses) {
  if (has_tree()) return tree_.variance(responses);
  const pose_graph::ExtendedGraph graph = weighted_graph();
  std::vector<std::size_t> nodes;
  Eigen::Matrix3Xd J(3, static_cast<Eigen::Index>(3 * responses.size()));
  for (const CliqueTree::Response& response : responses) {
    const int keyframe = keyframe_of(response.variable);
    const bool is_pose = !is_errors(response.variable);
    J.middleCols<3>(static_cast<Eigen::Index>(3 * nodes.size())) =
        is_pose ? response.J * planar_rotation(-problem_.nodes[at(keyframe)].theta) : response.J;
    nodes.push_back(at(is_pose ? keyframe : graph.node_of[at(keyframe)]));
  }
  const auto joint = pose_graph::joint_covariance(graph.edges, graph.nodes, nodes);
  if (!joint) return std::nullopt;
  return J * *joint * J.transpose();
}

// Of the motion from a keyframe to the newest: by the tree as far as it goes, then step by step.
std::optional<Eigen::Matrix3d> Smoother::motion_covariance(int from) {
  const int last = last_inside();
  UncertainPose motion{{}, Eigen::Matrix3d::Zero()};
  if (from < last) {
    const MotionInTree in_tree = motion_in_tree(from, last);
    const auto known = variance(in_tree.responses);
    if (!known) return std::nullopt;
    motion = {in_tree.mean, *known};
  }
  for (int k = std::max(from, last); k + 1 < problem_.size(); ++k) {
    motion = compose(motion, outside_.steps[at(k - last)]);
  }
  return motion.covariance;
}

Smoother::MotionInTree Smoother::motion_in_tree(int from, int to) {
  for (const int k : {from, to}) tree_.settle(k);
  double h[3];
  offset_of(problem_.nodes[at(from)], problem_.nodes[at(to)], h);
  Eigen::Matrix3d T = Eigen::Matrix3d::Identity();
  T(0, 2) = -h[1];
  T(1, 2) = h[0];
  return {{h[0], h[1], wrap_angle(h[2])}, {{from, -T}, {to, planar_rotation(h[2])}}};
}

// Of h(x) + G_from n_from + G_to n_to. n that is not in the tree is as its prior says, and as the
// edge does that it is folded into.
std::optional<Eigen::Matrix3d> Smoother::shared_covariance(const RelativePose& z) {
  const int from = static_cast<int>(z.from);
  const int last = last_inside();
  UncertainPose outside{{}, Eigen::Matrix3d::Zero()};
  for (int k = std::max(from, last); k + 1 < problem_.size(); ++k) {
    outside = compose(outside, outside_.steps[at(k - last)]);
  }
  MotionInTree motion;
  if (from < last) motion = motion_in_tree(from, last);
  Eigen::Matrix3d J_tree;
  Eigen::Matrix3d J_outside;
  compose(motion.mean, outside.mean, &J_tree, &J_outside);
  for (CliqueTree::Response& response : motion.responses) response.J = J_tree * response.J;
  Eigen::Matrix3d S = transport(J_outside, outside.covariance);
  const auto add_errors = [&](std::size_t k, const Eigen::Matrix3d& G) {
    const int keyframe = static_cast<int>(k);
    if (problem_.pictures.has(keyframe)) {
      motion.responses.push_back({errors_of(keyframe), G});
    } else {
      S += G * G.transpose();
    }
  };
  add_errors(z.from, z.shared->from.scaled());
  add_errors(z.to, z.shared->to.scaled());
  for (const auto& [e, X] : problem_.pictures.folded_of(z, problem_.edges)) {
    const Edge& edge = problem_.edges[at(e)];
    const Eigen::Matrix3d XW = X * pose_graph::full(edge.W);
    S -= transport(X, pose_graph::full(edge.W));
    const MotionInTree known = motion_in_tree(edge.from, edge.to);
    for (const CliqueTree::Response& response : known.responses) {
      motion.responses.push_back({response.variable, -XW * response.J});
    }
    if (edge.shared == nullptr) continue;
    for (const pose_graph::SharedEnds::End* end : {&edge.shared->from, &edge.shared->to}) {
      if (end->node >= 0) motion.responses.push_back({errors_of(end->node), -XW * end->G});
    }
  }
  const auto known = variance(motion.responses);
  if (!known) return std::nullopt;
  return S + *known;
}

}  // namespace fathom::incremental_smoother
