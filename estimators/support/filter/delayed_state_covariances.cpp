// The covariances of poses and motions: blocks of the state's.

#include <utility>

#include "estimators/support/filter/delayed_state.hpp"
#include "fathom/estimation/joint_covariance.hpp"
#include "fathom/geometry/covariance.hpp"

namespace fathom::filter {

Eigen::Matrix3d DelayedStateFilter::world_block(std::size_t k, std::size_t l) const {
  const Eigen::Matrix3d block = P_.block(block_of(k), block_of(l));
  const auto G = world_from_error(k);
  if (!G) return block;
  return *G * block * world_from_error(l)->transpose();
}

Eigen::MatrixXd DelayedStateFilter::world_covariance() const {
  Eigen::MatrixXd P = P_.full();
  for (std::size_t k = 1; k < poses_.size(); ++k) {
    const auto G = world_from_error(k);
    if (!G) return P;
    P.middleRows<3>(3 * block_of(k)) = (*G * P.middleRows<3>(3 * block_of(k))).eval();
    P.middleCols<3>(3 * block_of(k)) = (P.middleCols<3>(3 * block_of(k)) * G->transpose()).eval();
  }
  return P;
}

void DelayedStateFilter::set_world_covariance(Eigen::MatrixXd P) {
  for (std::size_t k = 1; k < poses_.size(); ++k) {
    const auto G = world_from_error(k);
    if (!G) break;
    const Eigen::Matrix3d inverse = inverse_of(*G);
    P.middleRows<3>(3 * block_of(k)) = (inverse * P.middleRows<3>(3 * block_of(k))).eval();
    P.middleCols<3>(3 * block_of(k)) =
        (P.middleCols<3>(3 * block_of(k)) * inverse.transpose()).eval();
  }
  PackedCovariance packed;
  for (Eigen::Index row = 0; row < P.rows(); row += 3) {
    const Eigen::Matrix3d own = P.block<3, 3>(row, row);
    const Eigen::Matrix3d symmetric = 0.5 * (own + own.transpose());
    if (row == 0) {
      packed.append(symmetric);
    } else {
      packed.append(P.block(row, 0, 3, row), symmetric);
    }
  }
  P_ = std::move(packed);
}

std::optional<Eigen::Matrix3d> DelayedStateFilter::covariance(std::size_t k) const {
  if (k == 0) return Eigen::Matrix3d::Zero();
  return world_block(k, k) + spread_of(k, k);
}

std::optional<Eigen::MatrixXd> DelayedStateFilter::joint_covariance(
    std::span<const std::size_t> keyframes) const {
  const std::vector<std::size_t> free = free_keyframes(keyframes);
  const auto size = static_cast<Eigen::Index>(3 * free.size());
  Eigen::MatrixXd joint(size, size);
  for (Eigen::Index i = 0; i < size; i += 3) {
    for (Eigen::Index j = i; j < size; j += 3) {
      const std::size_t a = free[static_cast<std::size_t>(i / 3)];
      const std::size_t b = free[static_cast<std::size_t>(j / 3)];
      joint.block<3, 3>(i, j) = world_block(a, b) + spread_of(a, b);
    }
  }
  return in_order_of(keyframes, joint);
}

std::optional<std::vector<UncertainPose>> DelayedStateFilter::motions_to_newest() const {
  std::vector<UncertainPose> motions;
  const std::size_t n = poses_.size() - 1;
  if (n == 0) return motions;
  motions.reserve(n);
  const auto G_n = world_from_error(n);
  Eigen::MatrixX3d column = P_.column(block_of(n));
  if (G_n) column = (column * G_n->transpose()).eval();
  PairCovariance pair;
  pair.B = world_block(n, n);
  for (std::size_t k = 0; k < n; ++k) {
    if (k > 0) {
      pair.A = world_block(k, k);
      pair.cross = column.middleRows<3>(3 * block_of(k));
      if (G_n) pair.cross = (*world_from_error(k) * pair.cross).eval();
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

}  // namespace fathom::filter
