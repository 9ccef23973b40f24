#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimators/support/filter/packed_covariance.hpp"
#include "estimators/support/filter/picture_error_states.hpp"
#include "fathom/estimation/gate.hpp"
#include "fathom/estimation/loop_rows.hpp"
#include "fathom/estimation/relative_estimator.hpp"
#include "fathom/estimation/shared_error_model.hpp"

namespace fathom::filter {

/// `max_iterations` and `tolerance` are keys that every estimator's configuration shares, so that
/// changing the back end is changing one word. One linearisation is within any limit, and there is
/// nothing that a tolerance could end.
struct DelayedStateOptions {
  int max_iterations = 1;
  double tolerance = 1e-6;
  /// Of the cost before the update, or of 1: below it a χ² is good whatever it was. An update that
  /// helps lowers the cost; ten times as much is no linearisation error.
  double divergence_factor = 10.0;
  GateOptions gate;
  /// With n as states a registration is so precise that one linearisation of it is not honest
  /// (docs/shared_errors.md).
  SharedErrorOptions shared_errors{SharedErrorModel::consider};

  void describe(OptionTable& table);
};

/// An EKF whose state is the stack of absolute keyframe poses 1 … n (keyframe 0 is fixed and has no
/// entry), each update linearised once. What an error of the state is, and where its Jacobians are
/// taken, is for those that derive from it to say; here it is that of (x, y, θ) in world axes, at
/// the present estimate: the plain EKF (docs/estimators/ekf.md).
///
/// With ε the error of the state, P its covariance, and G_k that of world_from_error:
///
///     δX_k = G_k ε_k,     H_k = ∂h/∂X_k G_k,     ε_{n+1} = G_{n+1}⁻¹ (J_X G_n ε_n + J_u w).
///
/// Of a registration that is told what its pictures share (RelativePose::shared) the two n are in P
/// too, a block of three each, in units of σ: appended with the first such registration of a
/// picture, uncorrelated, of the prior I. They are corrected like poses (`states`), or only
/// considered (`consider`): n̂ stays 0 and its block I, while S, the gain of the poses and their
/// covariance with n are those of the joint state (Schmidt-Kalman). `independent` takes the total.
class DelayedStateFilter : public RelativeEstimator {
 public:
  DelayedStateFilter(const EstimatorSetup& setup, const DelayedStateOptions& options);

  void add_keyframe(const RelativePose& step) override;
  UpdateReport close_loops(std::span<const RelativePose> registrations) override;
  std::optional<LoopDecision> bridge(const Bridge& bridge) override;
  std::optional<Eigen::Matrix3d> covariance(std::size_t k) const override;
  std::optional<Eigen::MatrixXd> joint_covariance(
      std::span<const std::size_t> keyframes) const override;
  std::size_t size() const override { return poses_.size(); }
  Pose pose(std::size_t k) const override { return poses_[k]; }
  bool estimates_shared_errors() const override { return model_ == SharedErrorModel::states; }
  /// From the joint blocks of both keyframes.
  std::optional<std::vector<UncertainPose>> motions_to_newest() const override;
  /// P of the whole state, and which of its blocks are of errors of pictures.
  const PackedCovariance& state_covariance() const { return P_; }
  const PictureErrorStates& picture_errors() const { return errors_; }

 protected:
  /// Where Jacobians with respect to the pose of keyframe k are taken.
  virtual Pose linearised_at(std::size_t k) const { return poses_[k]; }
  /// G_k: from the error in the state to that of (x, y, θ) of keyframe k, world axes: the identity
  /// but for what a turn does to x and y. Nothing: the identity.
  virtual std::optional<Eigen::Matrix3d> world_from_error(std::size_t k) const {
    (void)k;
    return std::nullopt;
  }
  /// The pose with an error ε.
  virtual Pose corrected(const Pose& pose, const Eigen::Vector3d& error) const;
  /// A keyframe has been added, as the newest.
  virtual void note_added() {}
  /// Keyframe k was moved with all of its part of the map, to where `motion` takes it.
  virtual void note_moved(std::size_t k, const Pose& motion) {
    (void)k;
    (void)motion;
  }

 private:
  /// One loop against the present state: ν = z − h(x), h = ⊖X_from ⊕ X_to, and of a semi-definite
  /// one the rows that it measures. Of one that is told what is shared, less G n̂ of both pictures,
  /// and R is that of its own errors.
  struct Innovation {
    std::size_t from = 0;
    std::size_t to = 0;
    Pose motion;
    LoopRows rows;
    Eigen::Vector3d nu;
    Eigen::Matrix3d H_from;  ///< of errors in the state
    Eigen::Matrix3d H_to;
    bool is_told = false;
    Eigen::Matrix3d G_from;  ///< of n in units of σ; where it is told
    Eigen::Matrix3d G_to;
  };
  struct Stack;
  /// A part of the map behind a hole that nothing has crossed. Its keyframes are in P as if the
  /// first of them were exact, and are uncorrelated with others: what is not known of its place
  /// must not enter the products of Jacobians at different estimates, which would take loops within
  /// it for knowledge of its heading.
  struct Floating {
    std::size_t node = 0;    ///< the one after the hole
    Eigen::Matrix3d spread;  ///< covariance of its pose, world axes
  };

  /// Block of the pose of keyframe k in the state, rising with k; keyframe 0 has none.
  Eigen::Index block_of(std::size_t k) const { return block_of_[k]; }
  /// Appends the pose of the newest keyframe.
  void append(const Eigen::Matrix3Xd& cross, const Eigen::Matrix3d& covariance);

  /// J_X of X_n ⊕ u = `next`.
  Eigen::Matrix3d step_jacobian(std::size_t n, const Pose& next) const;
  /// The block of P as that of errors of (x, y, θ), world axes.
  Eigen::Matrix3d world_block(std::size_t k, std::size_t l) const;
  Eigen::MatrixXd world_covariance() const;
  void set_world_covariance(Eigen::MatrixXd P);
  /// Whether the update asks what the registration's pictures share.
  bool is_told(const RelativePose& z) const {
    return z.shared != nullptr && model_ != SharedErrorModel::independent;
  }
  /// The errors of its pictures enter the state, if they are not in it.
  void admit(const RelativePose& z);
  bool is_resolved_as_used(const RelativePose& z) const;
  /// z, less what n̂ says of it.
  Pose corrected_motion(const Innovation& z) const;
  Innovation innovate(const RelativePose& z) const;
  LoopDecision decide(const Innovation& z) const;
  /// What the covariance of two poses has beyond its block of P: of one floating part; world axes.
  Eigen::Matrix3d spread_of(std::size_t k, std::size_t l) const;
  /// The poses of a floating part are in P as they are known, from now on.
  void settle(std::size_t part);
  /// The nodes that move, and the rows and columns of their covariance, world axes.
  void move(const std::vector<bool>& moves, const Pose& motion, Eigen::MatrixXd& P);
  /// The loop takes the place of the hole.
  void join(const Bridge& bridge, const Innovation& z);
  Eigen::MatrixX3d covariance_times_transposed(const Innovation& innovation) const;
  Eigen::MatrixXd projected(std::span<const Innovation> stack, const Eigen::MatrixXd& PHt) const;
  Eigen::Vector3d innovation_of(const Innovation& z) const;
  Stack stack(std::span<const Innovation> loops) const;
  void gate_together(std::vector<Innovation>& accepted, UpdateReport& report) const;
  Outcome update(std::span<const Innovation> accepted);
  /// Adds dx to the state.
  void correct(const Eigen::VectorXd& dx);

  double divergence_factor_;
  Gate gate_;
  SharedErrorModel model_;
  std::vector<Pose> poses_;
  std::vector<Eigen::Index> block_of_{-1};
  PictureErrorStates errors_;
  PackedCovariance P_;
  std::vector<Floating> floating_;
  std::vector<std::size_t> part_of_{0};  ///< 0, or 1 + the index of its floating part
};

/// G⁻¹, as (G − I)² is zero.
inline Eigen::Matrix3d inverse_of(const Eigen::Matrix3d& world_from_error) {
  return 2.0 * Eigen::Matrix3d::Identity() - world_from_error;
}

/// An entry for one of these; the options are the same for all.
template <class Filter>
EstimatorEntry delayed_state_entry(std::string name, std::string help) {
  EstimatorEntry entry = make_relative_entry<DelayedStateOptions>(
      std::move(name), std::move(help), false,
      [](const EstimatorSetup& setup, const DelayedStateOptions& options) {
        return std::make_unique<Filter>(setup, options);
      });
  entry.unused_options = {"max_iterations", "tolerance"};
  return entry;
}

}  // namespace fathom::filter
