#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "estimators/trajectory_iekf/motion_tree.hpp"
#include "estimators/trajectory_iekf/state_blocks.hpp"
#include "fathom/geometry/pose.hpp"

namespace fathom {

/// The stretch of relative motions that the registrations ending at the newest keyframe n depend
/// on: those after keyframe `first`, the earliest `from` of them. Gives h and H of the paper's
/// section 3 (docs/estimators/trajectory_iekf.md).
///
/// In a tree `first` is the first motion on any of their ways, and the poses are of all keyframes.
class Stretch {
 public:
  /// `motions` are x_{first+1} … x_n.
  Stretch(std::size_t first, std::span<const Pose> motions);
  /// `motions` are all motions. The tree must outlive the stretch.
  Stretch(const MotionTree& tree, std::size_t first, std::span<const Pose> motions);

  std::size_t first() const { return first_; }

  /// The way from `from` to n.
  std::vector<MotionTree::Part> way(std::size_t from) const;

  /// h = x_{from+1} ⊕ … ⊕ x_n: the pose of keyframe n in the frame of `from` ≥ first.
  Pose h(std::size_t from) const;

  /// H: the 3×3(n − first) Jacobian of h(from) with respect to the (x, y, θ) of each motion of the
  /// stretch; zero for motions that are not on the way.
  Eigen::Matrix3Xd H(std::size_t from) const;

  /// H = D(from)ᵀ A for the motions on the way, −D(from)ᵀ A where it goes against them: A, in the
  /// axes of `first` (in a tree, of keyframe 0), is the same for all registrations. Aᵀ,
  /// 3(n − first)×3; and D = diag(Rot(θ of `from` in the frame of `first`), 1).
  Eigen::MatrixX3d A_transposed() const;
  Eigen::Matrix3d D(std::size_t from) const;

 private:
  const Pose& pose(std::size_t k) const { return poses_[k - first_pose_]; }
  std::size_t newest() const { return first_pose_ + poses_.size() - 1; }

  std::size_t first_;
  std::size_t first_pose_;
  const MotionTree* tree_ = nullptr;  ///< none: a chain
  std::vector<Pose> poses_;           ///< of keyframes first … n, in the frame of `first`
};

/// H of registrations stacked, by its structure: never multiplied out. Of the motions of a stretch;
/// or, placed in a state that has errors of pictures too, of the last blocks of that.
class StackedJacobian {
 public:
  /// One registration: H of its `from`, or C H.
  struct Rows {
    std::size_t from = 0;
    const Eigen::Matrix3d* C = nullptr;
  };
  StackedJacobian() = default;
  StackedJacobian(const Stretch& stretch, std::span<const Rows> registrations);

  /// Among the blocks of a state, with H of n beside that of the motions.
  void place_in(const StateBlocks& state, PictureJacobian pictures);

  /// Motions (blocks) at which a registration's H begins or ends to be D A or −D A, counted from 0;
  /// rising, each once. The first is where the stretch begins, with n of its pictures.
  std::span<const Eigen::Index> starts() const { return starts_; }
  const Eigen::MatrixX3d& A_transposed() const { return A_transposed_; }

  /// E, 3 starts × 3 registrations: X Hᵀ is (X Aᵀ summed over the motions from each start on) E,
  /// and the part of n.
  const Eigen::MatrixXd& ends() const { return E_; }
  const PictureJacobian& pictures() const { return pictures_; }

  /// H X and Hᵀ λ, X over the stretch.
  Eigen::MatrixXd times(const Eigen::Ref<const Eigen::MatrixXd>& X) const;
  Eigen::VectorXd transposed_times(const Eigen::VectorXd& lambda) const;

 private:
  Eigen::Index row_of(std::size_t start) const { return 3 * (starts_[start] - starts_.front()); }

  std::vector<Eigen::Index> starts_;
  Eigen::MatrixXd E_;  ///< D of each registration, in the rows of its starts; −D where it ends
  Eigen::MatrixX3d A_transposed_;  ///< zero in the rows of n
  PictureJacobian pictures_;
};

}  // namespace fathom
