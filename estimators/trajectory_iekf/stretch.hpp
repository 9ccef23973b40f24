#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "fathom/geometry/pose.hpp"

namespace fathom {

/// The stretch of relative motions that the registrations ending at the newest keyframe n depend
/// on: those after keyframe `first`, the earliest `from` of them. Gives h and H of the paper's
/// section 3 (docs/estimators/trajectory_iekf.md).
class Stretch {
 public:
  /// `motions` are x_{first+1} … x_n.
  Stretch(std::size_t first, std::span<const Pose> motions);

  std::size_t first() const { return first_; }

  /// h = x_{from+1} ⊕ … ⊕ x_n: the pose of keyframe n in the frame of `from` ≥ first.
  Pose h(std::size_t from) const;

  /// H: the 3×3(n − first) Jacobian of h(from) with respect to the (x, y, θ) of each motion of the
  /// stretch; zero for motions up to `from`.
  Eigen::Matrix3Xd H(std::size_t from) const;

  /// H = D(from)ᵀ A for the motions after `from`: A, in the axes of `first`, is the same for all
  /// registrations. Aᵀ, 3(n − first)×3; and D = diag(Rot(θ of `from` in the frame of `first`), 1).
  Eigen::MatrixX3d A_transposed() const;
  Eigen::Matrix3d D(std::size_t from) const;

 private:
  std::size_t first_;
  std::vector<Pose> poses_;  ///< of keyframes first … n, in the frame of `first`
};

/// H of registrations stacked, by its structure: never multiplied out.
class StackedJacobian {
 public:
  /// One registration: H of its `from`, or C H.
  struct Rows {
    std::size_t from = 0;
    const Eigen::Matrix3d* C = nullptr;
  };
  StackedJacobian(const Stretch& stretch, std::span<const Rows> registrations);

  /// Motions from which on a registration's H is not zero, counted from 0; rising, each once.
  std::span<const Eigen::Index> starts() const { return starts_; }
  const Eigen::MatrixX3d& A_transposed() const { return A_transposed_; }

  /// E, 3 starts × 3 registrations: X Hᵀ is (X Aᵀ summed over the motions from each start on) E.
  const Eigen::MatrixXd& ends() const { return E_; }

  /// H X and Hᵀ λ, X over the stretch.
  Eigen::MatrixXd times(const Eigen::Ref<const Eigen::MatrixXd>& X) const;
  Eigen::VectorXd transposed_times(const Eigen::VectorXd& lambda) const;

 private:
  Eigen::Index row_of(std::size_t start) const { return 3 * (starts_[start] - starts_.front()); }

  std::vector<Eigen::Index> starts_;
  Eigen::MatrixXd E_;  ///< D of each registration, in the rows of its start
  Eigen::MatrixX3d A_transposed_;
};

}  // namespace fathom
