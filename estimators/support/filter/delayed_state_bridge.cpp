// Parts of a filter's map behind holes, and the loops that put them into place.

#include <cmath>
#include <span>
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

/// What one pose or n has in an error: J times its own.
struct Term {
  Eigen::Index row = 0;
  Eigen::Matrix3d J;
};

// The covariance after δX_k += A_k (Σ J δ + w), for the poses `changed` of A_k, the terms of the
// sum, and w of covariance W, independent. T P Tᵀ is T P by rows, then its transpose by rows again,
// as P is symmetric; only the lower triangle gets W.
void add_error(std::span<const Term> changed, std::span<const Term> terms, const Eigen::Matrix3d& W,
               Eigen::MatrixXd& P) {
  for (int side = 0; side < 2; ++side) {
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(3, P.cols());
    for (const auto& [row, J] : terms) sum += J * P.middleRows<3>(row);
    for (const auto& [row, A] : changed) P.middleRows<3>(row) += A * sum;
    P.transposeInPlace();
  }
  for (std::size_t i = 0; i < changed.size(); ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      P.block<3, 3>(changed[i].row, changed[j].row) += changed[i].J * W * changed[j].J.transpose();
    }
  }
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
void DelayedStateFilter::move(const std::vector<bool>& moves, const Pose& motion,
                              Eigen::MatrixXd& P) {
  const Eigen::Matrix3d turn = planar_rotation(motion.theta);
  for (std::size_t k = 1; k < poses_.size(); ++k) {
    if (!moves[k]) continue;
    poses_[k] = compose(motion, poses_[k]);
    note_moved(k, motion);
    P.middleRows<3>(3 * block_of(k)) = (turn * P.middleRows<3>(3 * block_of(k))).eval();
    P.middleCols<3>(3 * block_of(k)) = (P.middleCols<3>(3 * block_of(k)) * turn.transpose()).eval();
  }
}

std::optional<LoopDecision> DelayedStateFilter::bridge(const Bridge& bridge) {
  if (!bridge.loop) {
    Eigen::MatrixXd P = world_covariance();
    move(bridge.moves, bridge.motion, P);
    set_world_covariance(std::move(P));
    return std::nullopt;
  }
  admit(*bridge.loop);
  const Innovation z = innovate(*bridge.loop);
  const LoopDecision decision = decide(z);
  if (!decision.nis || !std::isfinite(*decision.nis)) return std::nullopt;
  if (decision.fate == LoopFate::used) join(bridge, z);
  return decision;
}

// One end of the loop, c, moves, and the other, p, does not. Of the part of c the poses relative to
// c keep their errors, X_k = X_c ⊕ r_k, and X_c' = X_p ⊕ m with m the loop, from p to c. With
// Φ = diag(Rot(φ), 1) of the turn φ, A_k' = [I  J (p_k' − p_c')], and ′ for what is after,
//
//     δX_k' = Φ δX_k − A_k' Φ δX_c + A_k' δX_c',     δX_c' = J_p δX_p + J_m δm.
//
// Of a loop z that is told what is shared, m is z less G n̂, or that reversed, J_z = ∂X_c'/∂z, and
// J_m δm = −J_z (G_from δn_from + G_to δn_to + ν): the pose is correlated with n from here on.
//
// Other parts that hang on it move along, and stay uncorrelated with it.
void DelayedStateFilter::join(const Bridge& bridge, const Innovation& z) {
  const bool is_to = bridge.moves[z.to];
  const std::size_t c = is_to ? z.to : z.from;
  const std::size_t p = is_to ? z.from : z.to;
  const UncertainPose loop{corrected_motion(z), z.rows.R};
  const UncertainPose m = is_to ? loop : inverse(loop);
  Eigen::MatrixXd P = world_covariance();
  move(bridge.moves, compose(compose(poses_[p], m.mean), inverse(poses_[c])), P);
  Eigen::Matrix3d J_p;
  Eigen::Matrix3d J_m;
  poses_[c] = compose(poses_[p], m.mean, &J_p, &J_m);
  if (linearised_at(p) != poses_[p]) J_p = step_jacobian(p, linearised_at(c));
  std::vector<Term> ends{{3 * block_of(c), -Eigen::Matrix3d::Identity()}};
  if (p > 0) ends.push_back({3 * block_of(p), J_p});
  if (z.is_told) {
    Eigen::Matrix3d J_z = J_m;
    if (!is_to) {
      Eigen::Matrix3d J_reversal;
      inverse(loop.mean, &J_reversal);
      J_z = J_m * J_reversal;
    }
    ends.push_back({3 * errors_.block_of(z.from), -J_z * z.G_from});
    ends.push_back({3 * errors_.block_of(z.to), -J_z * z.G_to});
  }
  std::vector<Term> moved;
  for (std::size_t k = 1; k < poses_.size(); ++k) {
    if (!bridge.moves[k] || part_of_[k] != part_of_[c]) continue;
    moved.push_back(
        {3 * block_of(k), carried(linearised_at(k).position() - linearised_at(c).position())});
  }
  add_error(moved, ends, transport(J_m, m.covariance), P);
  set_world_covariance(std::move(P));
  const std::size_t part = part_of_[c];
  for (std::size_t& of : part_of_) of = of == part ? part_of_[p] : of;
}

}  // namespace fathom::filter
