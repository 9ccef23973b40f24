// What a Smoother's tree says of uncertainty.

#include <algorithm>

#include "estimators/incremental_smoother/smoother.hpp"

namespace fathom::incremental_smoother {

std::optional<std::vector<Eigen::Matrix3d>> Smoother::predicted_covariances(
    std::span<const RelativePose> forward_loops) {
  if (!has_tree()) return std::nullopt;
  std::vector<Eigen::Matrix3d> result;
  for (const RelativePose& z : forward_loops) {
    result.push_back(has_states(z) ? shared_covariance(z)
                                   : motion_covariance(static_cast<int>(z.from)));
  }
  return result;
}

// The origin is exact, so the motion from it is all that is uncertain.
std::optional<Eigen::Matrix3d> Smoother::newest_covariance() {
  if (!has_tree()) return std::nullopt;
  return transport(planar_rotation(problem_.nodes[0].theta), motion_covariance(0));
}

// Of the motion from a keyframe to the newest: by the tree as far as it goes, then step by step.
Eigen::Matrix3d Smoother::motion_covariance(int from) {
  const int last = outside_.first - 1;
  UncertainPose motion{{}, Eigen::Matrix3d::Zero()};
  if (from < last) {
    const MotionInTree in_tree = motion_in_tree(from, last);
    motion = {in_tree.mean, tree_.variance(in_tree.responses)};
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
Eigen::Matrix3d Smoother::shared_covariance(const RelativePose& z) {
  const int from = static_cast<int>(z.from);
  const int last = outside_.first - 1;
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
  return S + tree_.variance(motion.responses);
}

}  // namespace fathom::incremental_smoother
