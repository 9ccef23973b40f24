// Parts of a filter's map behind holes, and the loops that put them into place.

#include <cmath>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "estimators/support/filter/delayed_state.hpp"
#include "fathom/geometry/covariance.hpp"

namespace fathom::filter {
namespace {

// [I  J p] with J a quarter turn: what a turn about one place does at `lever` from it.
Eigen::Matrix3d carried(const Eigen::Vector2d& lever) {
  Eigen::Matrix3d A = Eigen::Matrix3d::Identity();
  A.topRightCorner<2, 1>() << -lever.y(), lever.x();
  return A;
}

}  // namespace

Eigen::Matrix3d DelayedStateFilter::spread_of(std::size_t k, std::size_t l) const {
  if (part_of_[k] == 0 || part_of_[k] != part_of_[l]) return Eigen::Matrix3d::Zero();
  const Floating& part = floating_[part_of_[k] - 1];
  const auto from_first = [&](std::size_t i) {
    return carried(linearised_at(i).position() - linearised_at(part.node).position());
  };
  return from_first(k) * part.spread * from_first(l).transpose();
}

void DelayedStateFilter::settle(std::size_t part) {
  if (part == 0) return;
  Eigen::MatrixXd P = world_covariance();
  for (std::size_t k = 1; k < poses_.size(); ++k) {
    for (std::size_t l = 1; l <= k; ++l) {
      if (part_of_[k] != part || part_of_[l] != part) continue;
      P.block<3, 3>(3 * block_of(k), 3 * block_of(l)) += spread_of(k, l);
    }
  }
  set_world_covariance(std::move(P));
  for (std::size_t& of : part_of_) of = of == part ? 0 : of;
}

// Relative to each other they keep their errors: the covariances turn with the map.
void DelayedStateFilter::move(const Bridge& bridge, Eigen::MatrixXd& P) {
  const Eigen::Matrix3d turn = planar_rotation(bridge.motion.theta);
  for (std::size_t k = 1; k < poses_.size(); ++k) {
    if (!bridge.moves[k]) continue;
    poses_[k] = compose(bridge.motion, poses_[k]);
    note_moved(k, bridge.motion);
    P.middleRows<3>(3 * block_of(k)) = (turn * P.middleRows<3>(3 * block_of(k))).eval();
    P.middleCols<3>(3 * block_of(k)) = (P.middleCols<3>(3 * block_of(k)) * turn.transpose()).eval();
  }
}

// One end of the loop, c, moves, and the other, p, does not. Of the part of c the poses relative to
// c keep their errors, X_k = X_c ⊕ r_k, and X_c' = X_p ⊕ m with m the loop, from p to c. With
// Φ = diag(Rot(φ), 1) of the turn φ, A_k' = [I  J (p_k' − p_c')], and ′ for what is after,
//
//     δX_k' = Φ δX_k − A_k' Φ δX_c + A_k' δX_c',     δX_c' = J_p δX_p + J_m δm.
//
// Other parts that hang on it move along, and stay uncorrelated with it.
std::optional<LoopDecision> DelayedStateFilter::bridge(const Bridge& bridge) {
  Eigen::MatrixXd P = world_covariance();
  if (!bridge.loop) {
    move(bridge, P);
    set_world_covariance(std::move(P));
    return std::nullopt;
  }
  const LoopDecision decision = decide(innovate(*bridge.loop));
  if (!decision.nis || !std::isfinite(*decision.nis)) return std::nullopt;
  if (decision.fate != LoopFate::used) return decision;
  const bool is_to = bridge.moves[bridge.loop->to];
  const std::size_t c = is_to ? bridge.loop->to : bridge.loop->from;
  const std::size_t p = is_to ? bridge.loop->from : bridge.loop->to;
  const UncertainPose loop{bridge.loop->motion, bridge.loop->covariance()};
  const UncertainPose m = is_to ? loop : inverse(loop);
  move(bridge, P);
  Eigen::Matrix3d J_p;
  Eigen::Matrix3d J_m;
  poses_[c] = compose(poses_[p], m.mean, &J_p, &J_m);
  if (linearised_at(p) != poses_[p]) J_p = step_jacobian(p, linearised_at(c));
  const auto is_of_c = [&](std::size_t k) { return bridge.moves[k] && part_of_[k] == part_of_[c]; };
  const auto A = [&](std::size_t k) {
    return carried(linearised_at(k).position() - linearised_at(c).position());
  };
  // T P by rows, then its transpose by rows again: P is symmetric.
  for (int side = 0; side < 2; ++side) {
    Eigen::MatrixXd end = -P.middleRows<3>(3 * block_of(c));
    if (p > 0) end += J_p * P.middleRows<3>(3 * block_of(p));
    for (std::size_t k = 1; k < poses_.size(); ++k) {
      if (is_of_c(k)) P.middleRows<3>(3 * block_of(k)) += A(k) * end;
    }
    P.transposeInPlace();
  }
  const Eigen::Matrix3d of_loop = transport(J_m, m.covariance);
  for (std::size_t k = 1; k < poses_.size(); ++k) {
    for (std::size_t l = 1; l <= k; ++l) {
      if (!is_of_c(k) || !is_of_c(l)) continue;
      P.block<3, 3>(3 * block_of(k), 3 * block_of(l)) += A(k) * of_loop * A(l).transpose();
    }
  }
  set_world_covariance(std::move(P));
  const std::size_t part = part_of_[c];
  for (std::size_t& of : part_of_) of = of == part ? part_of_[p] : of;
  return decision;
}

}  // namespace fathom::filter
