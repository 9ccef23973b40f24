#include "estimators/trajectory_iekf/stretch.hpp"

#include "fathom/geometry/trajectory.hpp"

namespace fathom {

Stretch::Stretch(std::size_t first, std::span<const Pose> motions)
    : first_(first), poses_(compose_trajectory(Pose{}, motions)) {}

Pose Stretch::h(std::size_t from) const {
  return between(poses_[from - first_], poses_.back());
}

Eigen::Matrix3Xd Stretch::H(std::size_t from) const {
  const std::size_t n = poses_.size() - 1;
  const std::size_t start = from - first_;
  Eigen::Matrix3Xd H = Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(3 * n));
  const Pose& frame = poses_[start];
  const Eigen::Matrix2d to_frame = rotation(-frame.theta);
  for (std::size_t i = start + 1; i <= n; ++i) {
    const auto column = static_cast<Eigen::Index>(3 * (i - 1));
    // A translation of motion i acts along the axes of keyframe i − 1; a turn swings the rest of
    // the stretch, from keyframe i to n, about keyframe i.
    H.block<2, 2>(0, column) = rotation(poses_[i - 1].theta - frame.theta);
    const Eigen::Vector2d lever = to_frame * (poses_[n].position() - poses_[i].position());
    H.col(column + 2) << -lever.y(), lever.x(), 1.0;
  }
  return H;
}

}  // namespace fathom
