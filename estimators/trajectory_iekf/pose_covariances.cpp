// The covariances of poses and motions, from that of the stacked motions.

#include "estimators/trajectory_iekf/trajectory_iekf.hpp"
#include "fathom/estimation/joint_covariance.hpp"
#include "fathom/geometry/covariance.hpp"

namespace fathom {

// B, three rows a motion: with B_iᵀ δx_i the motion of keyframe 0's place, carried along with
// keyframe i, for a change of motion i. It is the same for all keyframes that come later.
Eigen::MatrixX3d TrajectoryIekf::motions_at_origin() const {
  Eigen::MatrixX3d B(P_.size(), 3);
  const Eigen::Vector2d origin = poses_.front().position();
  for (std::size_t k = 0; k < motions_.size(); ++k) {
    const Eigen::Vector2d lever = origin - poses_[k + 1].position();
    const auto row = static_cast<Eigen::Index>(3 * k);
    B.block<2, 2>(row, 0) = rotation(-poses_[k].theta);
    B.block<2, 1>(row, 2).setZero();
    B.row(row + 2) << -lever.y(), lever.x(), 1.0;
  }
  return B;
}

// The change of a keyframe's pose for one of keyframe 0's place carried along with it.
Eigen::Matrix3d TrajectoryIekf::from_origin_to(std::size_t keyframe) const {
  const Eigen::Vector2d lever = poses_[keyframe].position() - poses_.front().position();
  Eigen::Matrix3d to_keyframe = Eigen::Matrix3d::Identity();
  to_keyframe.topRightCorner<2, 1>() << -lever.y(), lever.x();
  return to_keyframe;
}

// Σ B_iᵀ P_ij B_j over the motions up to k, taken from keyframe 0's place to keyframe k.
void TrajectoryIekf::compute_covariances() const {
  const auto sums = P_.congruences(motions_at_origin(), MotionCovariance::Over::motions_up_to);
  covariances_.assign(1, Eigen::Matrix3d::Zero());
  for (std::size_t k = 0; k < sums.size(); ++k) {
    covariances_.push_back(transport(from_origin_to(k + 1), sums[k]));
  }
}

std::optional<Eigen::Matrix3d> TrajectoryIekf::covariance(std::size_t k) const {
  if (covariances_.empty()) compute_covariances();
  return covariances_[k];
}

// J P Jᵀ, a product with P for each keyframe: B up to it, zero beyond.
std::optional<Eigen::MatrixXd> TrajectoryIekf::joint_covariance(
    std::span<const std::size_t> keyframes) const {
  const std::vector<std::size_t> free = free_keyframes(keyframes);
  const auto size = static_cast<Eigen::Index>(3 * free.size());
  Eigen::MatrixXd joint(size, size);
  const Eigen::MatrixX3d B = motions_at_origin();
  const Eigen::Index start = 0;
  Eigen::MatrixXd product(B.rows(), 3);
  for (std::size_t j = 0; j < free.size(); ++j) {
    Eigen::MatrixX3d B_j = B;
    B_j.bottomRows(B.rows() - static_cast<Eigen::Index>(3 * free[j])).setZero();
    P_.suffix_products(std::span(&start, 1), B_j, product);
    const Eigen::Matrix3d to_j = from_origin_to(free[j]);
    for (std::size_t i = 0; i <= j; ++i) {
      const auto rows = static_cast<Eigen::Index>(3 * free[i]);
      joint.block<3, 3>(static_cast<Eigen::Index>(3 * i), static_cast<Eigen::Index>(3 * j)) =
          from_origin_to(free[i]) * (B.topRows(rows).transpose() * product.topRows(rows)) *
          to_j.transpose();
    }
  }
  return in_order_of(keyframes, joint);
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
