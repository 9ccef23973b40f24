// The covariances of poses and motions: blocks of the state's.

#include "estimators/ekf/ekf.hpp"
#include "fathom/estimation/joint_covariance.hpp"
#include "fathom/geometry/covariance.hpp"

namespace fathom {

std::optional<Eigen::Matrix3d> Ekf::covariance(std::size_t k) const {
  if (k == 0) return Eigen::Matrix3d::Zero();
  return P_.block(block_of(k), block_of(k)) + spread_of(k, k);
}

std::optional<Eigen::MatrixXd> Ekf::joint_covariance(std::span<const std::size_t> keyframes) const {
  const std::vector<std::size_t> free = free_keyframes(keyframes);
  const auto size = static_cast<Eigen::Index>(3 * free.size());
  Eigen::MatrixXd joint(size, size);
  for (Eigen::Index i = 0; i < size; i += 3) {
    for (Eigen::Index j = i; j < size; j += 3) {
      const std::size_t a = free[static_cast<std::size_t>(i / 3)];
      const std::size_t b = free[static_cast<std::size_t>(j / 3)];
      joint.block<3, 3>(i, j) = P_.block(block_of(a), block_of(b)) + spread_of(a, b);
    }
  }
  return in_order_of(keyframes, joint);
}

std::optional<std::vector<UncertainPose>> Ekf::motions_to_newest() const {
  std::vector<UncertainPose> motions;
  const std::size_t n = poses_.size() - 1;
  if (n == 0) return motions;
  motions.reserve(n);
  const Eigen::MatrixX3d column = P_.column(block_of(n));
  PairCovariance pair;
  pair.B = P_.block(block_of(n), block_of(n));
  for (std::size_t k = 0; k < n; ++k) {
    if (k > 0) {
      pair.A = P_.block(block_of(k), block_of(k));
      pair.cross = column.middleRows<3>(3 * block_of(k));
    }
    PairCovariance whole = pair;
    if (part_of_[k] != part_of_[n]) {
      whole.A += spread_of(k, k);
      whole.B += spread_of(n, n);
    }
    motions.push_back(between(poses_[k], poses_[n], whole));
  }
  return motions;
}

}  // namespace fathom
