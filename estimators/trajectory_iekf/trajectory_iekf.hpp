#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimators/trajectory_iekf/motion_covariance.hpp"
#include "estimators/trajectory_iekf/stacked_loops.hpp"
#include "estimators/trajectory_iekf/stretch.hpp"
#include "fathom/estimation/gate.hpp"
#include "fathom/estimation/relative_estimator.hpp"

namespace fathom {

struct TrajectoryIekfOptions {
  int max_iterations = 10;
  double tolerance = 1e-6;
  bool safeguard = false;
  /// Of the cost of leaving the state alone, or of 1: below it a χ² is good whatever it was. Plain
  /// iterations that have not settled end a little above it at times (on ring, twice up to 1.5
  /// times), which is for `iteration_limit` to say.
  double divergence_factor = 10.0;
  GateOptions gate;

  void describe(OptionTable& table);
};

/// The trajectory-based iterated EKF of Burguera, Bonin-Font and Oliver, section 3: the state is
/// the stack of relative motions between consecutive keyframes, X = [x₁⁰; x₂¹; …], so that one loop
/// corrects every motion in it. docs/estimators/trajectory_iekf.md.
class TrajectoryIekf final : public RelativeEstimator {
 public:
  /// The form of the covariance changes what it costs alone.
  TrajectoryIekf(const EstimatorSetup& setup, const TrajectoryIekfOptions& options,
                 MotionCovariance::Form form = MotionCovariance::Form::cheapest);

  /// State augmentation: the dead-reckoning motion and its covariance block.
  void add_keyframe(const RelativePose& step) override;

  /// One iterated update with all registrations stacked (Bar-Shalom, Li, Kirubarajan).
  UpdateReport close_loops(std::span<const RelativePose> registrations) override;

  std::optional<LoopDecision> bridge(const Bridge& bridge) override;

  std::optional<Eigen::Matrix3d> covariance(std::size_t k) const override;
  std::optional<Eigen::MatrixXd> joint_covariance(
      std::span<const std::size_t> keyframes) const override;
  std::size_t size() const override { return poses_.size(); }
  Pose pose(std::size_t k) const override { return poses_[k]; }
  /// J P Jᵀ of the stretch from each keyframe on.
  std::optional<std::vector<UncertainPose>> motions_to_newest() const override;
  /// P of the whole state.
  const MotionCovariance& state_covariance() const { return P_; }

 private:
  /// The stacked registrations linearised at one iterate.
  struct Linearisation {
    Eigen::VectorXd nu;   ///< z − h(x), headings wrapped
    StackedJacobian H;    ///< over the stretch only; zero elsewhere
    filter::Scratch PAt;  ///< P Aᵀ, over the motions from each start on; P Hᵀ = (P Aᵀ) E
    Eigen::MatrixXd S;    ///< H P Hᵀ + R
  };
  struct Iterate;

  void linearise(std::span<const StackedLoop> loops, const Eigen::VectorXd& delta, int iteration);
  void linearise_prior(std::span<const StackedLoop> loops);
  void narrow_to(std::span<const StackedLoop> loops);
  void multiply(std::span<const StackedLoop> loops);
  std::vector<bool> gate_loops(std::span<const StackedLoop> loops, UpdateReport& report) const;
  Outcome iterate(std::span<const StackedLoop> loops, UpdateReport& report);
  double cost(std::span<const StackedLoop> loops, const Iterate& at) const;
  bool step_back(std::span<const StackedLoop> loops, const Iterate& from, Iterate& to) const;
  bool apply(const Iterate& end, int iterations);
  std::size_t first_of(std::span<const StackedLoop> loops) const;
  void recompose();
  void compute_covariances() const;
  std::vector<Eigen::Matrix3d> congruences_from(std::size_t root, const Eigen::MatrixX3d& B) const;
  Eigen::MatrixX3d on_way_to(std::size_t keyframe, const Eigen::MatrixX3d& B) const;
  Eigen::MatrixX3d motions_at_origin() const;
  Eigen::Matrix3d from_origin_to(std::size_t keyframe) const;

  TrajectoryIekfOptions options_;
  Gate gate_;
  std::vector<Pose> motions_;  ///< x_k of keyframe k stands at k − 1
  MotionTree tree_;            ///< what they lead between
  std::vector<Pose> poses_;    ///< their composition
  MotionCovariance P_;
  Linearisation at_;  ///< the present one
  filter::Scratch V_;
  mutable std::vector<Eigen::Matrix3d> covariances_;  ///< of the poses; empty: to be computed
};

EstimatorEntry trajectory_iekf_entry();

}  // namespace fathom
