// The covariances of poses and motions, from that of the stacked motions.

#include "estimators/trajectory_iekf/trajectory_iekf.hpp"
#include "fathom/geometry/covariance.hpp"

namespace fathom {

// With B_i the motion of keyframe 0's place, carried along with keyframe i, for a change of motion
// i: Σ B_iᵀ P_ij B_j over the motions up to k, taken from there to keyframe k.
void TrajectoryIekf::compute_covariances() {
  Eigen::MatrixX3d B(P_.size(), 3);
  const Eigen::Vector2d origin = poses_.front().position();
  for (std::size_t k = 0; k < motions_.size(); ++k) {
    const Eigen::Vector2d lever = origin - poses_[k + 1].position();
    const auto row = static_cast<Eigen::Index>(3 * k);
    B.block<2, 2>(row, 0) = rotation(-poses_[k].theta);
    B.block<2, 1>(row, 2).setZero();
    B.row(row + 2) << -lever.y(), lever.x(), 1.0;
  }
  const auto sums = P_.congruences(B, MotionCovariance::Over::motions_up_to);
  covariances_.assign(1, Eigen::Matrix3d::Zero());
  for (std::size_t k = 0; k < sums.size(); ++k) {
    const Eigen::Vector2d lever = poses_[k + 1].position() - origin;
    Eigen::Matrix3d to_keyframe = Eigen::Matrix3d::Identity();
    to_keyframe.topRightCorner<2, 1>() << -lever.y(), lever.x();
    covariances_.push_back(transport(to_keyframe, sums[k]));
  }
}

std::optional<Eigen::Matrix3d> TrajectoryIekf::covariance(std::size_t k) {
  if (covariances_.empty()) compute_covariances();
  return covariances_[k];
}

// H P Hᵀ with the H of each stretch: all have the same A.
std::optional<std::vector<UncertainPose>> TrajectoryIekf::motions_to_newest() const {
  const Stretch stretch(0, motions_);
  const auto sums = P_.congruences(stretch.A_transposed(), MotionCovariance::Over::motions_from);
  std::vector<UncertainPose> motions;
  for (std::size_t k = 0; k < sums.size(); ++k) {
    motions.push_back({stretch.h(k), transport(stretch.D(k).transpose(), sums[k])});
  }
  return motions;
}

}  // namespace fathom
