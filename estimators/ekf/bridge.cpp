// Ekf::bridge: all poses after a hole move as one, and their covariance with them.

#include <Eigen/Core>

#include "estimators/ekf/ekf.hpp"
#include "fathom/geometry/covariance.hpp"

namespace fathom {
namespace {

// [I  J p] with J a quarter turn: what a turn about one place does at `lever` from it.
Eigen::Matrix3d carried(const Eigen::Vector2d& lever) {
  Eigen::Matrix3d A = Eigen::Matrix3d::Identity();
  A.topRightCorner<2, 1>() << -lever.y(), lever.x();
  return A;
}

}  // namespace

// With X_k = X_g ⊕ r_k, X_g = X_{g−1} ⊕ u, and u' = u but for its value, r_k and u keep their
// errors. The poses turn by φ about the new X_g, Φ = diag(Rot(φ), 1):
//
//     δX_g' = δX_g + (C' − C) δX_{g−1},             C = [I  J (p_g − p_{g−1})],
//     δX_k' = Φ δX_k + A_k' (δX_g' − Φ δX_g),       A_k' = [I  J (p_k' − p_g')].
void Ekf::bridge(std::size_t node, const Pose& motion) {
  const std::vector<Pose> before = poses_;
  const Pose& last = before[node - 1];
  poses_[node] = compose(last, motion);
  for (std::size_t k = node + 1; k < poses_.size(); ++k) {
    poses_[k] = compose(poses_[node], between(before[node], before[k]));
  }
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn.topLeftCorner<2, 2>() = rotation(poses_[node].theta - before[node].theta);
  const Eigen::Matrix3d of_last = carried(poses_[node].position() - last.position()) -
                                  carried(before[node].position() - last.position());
  Eigen::MatrixXd P = P_.full();
  const Eigen::Index g = 3 * block_of(node);
  // T P by rows, then its transpose by rows again: P is symmetric.
  for (int side = 0; side < 2; ++side) {
    const Eigen::MatrixXd was = P.middleRows<3>(g);
    if (node > 1) P.middleRows<3>(g) += of_last * P.middleRows<3>(g - 3);
    const Eigen::MatrixXd shift = P.middleRows<3>(g) - turn * was;
    for (std::size_t k = node + 1; k < poses_.size(); ++k) {
      auto rows = P.middleRows<3>(3 * block_of(k));
      rows = (turn * rows + carried(poses_[k].position() - poses_[node].position()) * shift).eval();
    }
    P.transposeInPlace();
  }
  P_ = {};
  for (Eigen::Index row = 0; row < P.rows(); row += 3) {
    const Eigen::Matrix3d own = P.block<3, 3>(row, row);
    const Eigen::Matrix3d symmetric = 0.5 * (own + own.transpose());
    if (row == 0) {
      P_.append(symmetric);
    } else {
      P_.append(P.block(row, 0, 3, row), symmetric);
    }
  }
}

}  // namespace fathom
