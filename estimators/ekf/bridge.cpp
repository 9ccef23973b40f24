// Ekf::bridge: the poses behind a hole move as one, and a loop says where.

#include <cmath>
#include <vector>

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

// One end of the loop, c, moves, and the other, p, does not. Of the poses that move those relative
// to c keep their errors, X_k = X_c ⊕ r_k, and X_c' = X_p ⊕ m with m the loop, from p to c. With
// Φ = diag(Rot(φ), 1) of the turn φ, A_k = [I  J (p_k − p_c)], and ′ for what is after,
//
//     δX_k' = Φ (δX_k − A_k δX_c) + A_k' δX_c',     δX_c' = J_p δX_p + J_m δm.
std::optional<LoopDecision> Ekf::bridge(const Bridge& bridge) {
  const LoopDecision decision = decide(innovate(bridge.loop));
  if (!decision.nis || !std::isfinite(*decision.nis)) return std::nullopt;
  if (decision.fate != LoopFate::used) return decision;
  const bool is_to = bridge.moves[bridge.loop.to];
  const std::size_t c = is_to ? bridge.loop.to : bridge.loop.from;
  const std::size_t p = is_to ? bridge.loop.from : bridge.loop.to;
  const UncertainPose loop{bridge.loop.motion, bridge.loop.covariance()};
  const UncertainPose m = is_to ? loop : inverse(loop);

  const std::vector<Pose> before = poses_;
  Eigen::Matrix3d J_p;
  Eigen::Matrix3d J_m;
  poses_[c] = compose(before[p], m.mean, &J_p, &J_m);
  for (std::size_t k = 1; k < poses_.size(); ++k) {
    if (bridge.moves[k] && k != c) poses_[k] = compose(poses_[c], between(before[c], before[k]));
  }
  const Eigen::Matrix3d turn = planar_rotation(poses_[c].theta - before[c].theta);
  const auto after_c = [&](std::size_t k) {
    return carried(poses_[k].position() - poses_[c].position());
  };
  Eigen::MatrixXd P = P_.full();
  // T P by rows, then its transpose by rows again: P is symmetric.
  for (int side = 0; side < 2; ++side) {
    const Eigen::MatrixXd of_c = P.middleRows<3>(3 * block_of(c));
    Eigen::MatrixXd end = Eigen::MatrixXd::Zero(3, P.cols());
    if (p > 0) end = J_p * P.middleRows<3>(3 * block_of(p));
    for (std::size_t k = 1; k < poses_.size(); ++k) {
      if (!bridge.moves[k]) continue;
      auto rows = P.middleRows<3>(3 * block_of(k));
      const Eigen::Matrix3d before_c = carried(before[k].position() - before[c].position());
      rows = (turn * (rows - before_c * of_c) + after_c(k) * end).eval();
    }
    P.transposeInPlace();
  }
  const Eigen::Matrix3d of_loop = transport(J_m, m.covariance);
  P_ = {};
  for (std::size_t i = 1; i < poses_.size(); ++i) {
    const Eigen::Index row = 3 * block_of(i);
    if (bridge.moves[i]) {
      for (std::size_t j = 1; j <= i; ++j) {
        if (!bridge.moves[j]) continue;
        P.block<3, 3>(row, 3 * block_of(j)) += after_c(i) * of_loop * after_c(j).transpose();
      }
    }
    const Eigen::Matrix3d own = P.block<3, 3>(row, row);
    const Eigen::Matrix3d symmetric = 0.5 * (own + own.transpose());
    if (i == 1) {
      P_.append(symmetric);
    } else {
      P_.append(P.block(row, 0, 3, row), symmetric);
    }
  }
  return decision;
}

}  // namespace fathom
