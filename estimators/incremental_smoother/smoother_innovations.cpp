// What a Smoother's tree says of uncertainty.

#include <algorithm>

#include "estimators/incremental_smoother/smoother.hpp"

namespace fathom::incremental_smoother {

std::optional<std::vector<Eigen::Matrix3d>> Smoother::predicted_covariances(
    std::span<const RelativePose> forward_loops) {
  if (!has_tree()) return std::nullopt;
  std::vector<Eigen::Matrix3d> result;
  for (const RelativePose& z : forward_loops) {
    result.push_back(motion_covariance(static_cast<int>(z.from)));
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
    for (const int k : {from, last}) tree_.settle(k);
    const Node& i = problem_.nodes[at(from)];
    const Node& k = problem_.nodes[at(last)];
    double h[3];
    offset_of(i, k, h);
    Eigen::Matrix3d T = Eigen::Matrix3d::Identity();
    T(0, 2) = -h[1];
    T(1, 2) = h[0];
    const Eigen::Matrix3d Q = planar_rotation(h[2]);
    motion = {{h[0], h[1], wrap_angle(h[2])}, tree_.variance(from, -T, last, Q)};
  }
  for (int k = std::max(from, last); k + 1 < problem_.size(); ++k) {
    motion = compose(motion, outside_.steps[at(k - last)]);
  }
  return motion.covariance;
}

}  // namespace fathom::incremental_smoother
