#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimators/trajectory_iekf/motion_covariance.hpp"
#include "estimators/trajectory_iekf/stacked_loops.hpp"
#include "estimators/trajectory_iekf/state_blocks.hpp"
#include "estimators/trajectory_iekf/stretch.hpp"
#include "fathom/estimation/gate.hpp"
#include "fathom/estimation/relative_estimator.hpp"
#include "fathom/estimation/shared_error_model.hpp"

namespace fathom {

struct TrajectoryIekfOptions {
  /// Measured (docs/which_back_end.md): with fewer a single long loop stays open, with more several
  /// loops push each other off.
  int max_iterations = 5;
  double tolerance = 1e-6;
  bool safeguard = false;
  /// Of the cost of leaving the state alone, or of 1: below it a χ² is good whatever it was. Plain
  /// iterations that have not settled end a little above it at times (on ring, twice up to 1.5
  /// times), which is for `iteration_limit` to say.
  double divergence_factor = 10.0;
  GateOptions gate;
  /// The paper's: its state is the motions alone.
  SharedErrorOptions shared_errors{SharedErrorModel::independent};

  void describe(OptionTable& table);
};

/// The trajectory-based iterated EKF of Burguera, Bonin-Font and Oliver, section 3: the state is
/// the stack of relative motions between consecutive keyframes, X = [x₁⁰; x₂¹; …], so that one loop
/// corrects every motion in it. docs/estimators/trajectory_iekf.md.
///
/// Beyond the paper, where registrations are told what their pictures share: n of each is in the
/// state too (`states`), or considered in P and in the gains (`consider`).
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
  bool estimates_shared_errors() const override { return model() == SharedErrorModel::states; }
  /// J P Jᵀ of the stretch from each keyframe on.
  std::optional<std::vector<UncertainPose>> motions_to_newest() const override;
  /// P of the whole state, and whose its blocks are.
  const MotionCovariance& state_covariance() const { return P_; }
  const StateBlocks& blocks() const { return blocks_; }

 private:
  /// The stacked registrations linearised at one iterate.
  struct Linearisation {
    Eigen::VectorXd nu;   ///< z − h(x) − G n, headings wrapped
    StackedJacobian H;    ///< over the stretch only; zero elsewhere
    filter::Scratch PAt;  ///< P Aᵀ, over the motions from each start on; P Hᵀ = (P Aᵀ) E
    Eigen::MatrixXd PGt;  ///< P Gᵀ, all rows, of n: P Hᵀ = (P Aᵀ) E + P Gᵀ; empty: nothing told
    Eigen::MatrixXd S;  ///< H P Hᵀ + R
  };
  struct Iterate;

  SharedErrorModel model() const { return options_.shared_errors.model; }
  void admit(const RelativePose& z);
  bool are_resolved_as_used(std::span<const RelativePose> registrations) const;
  Stretch stretch_of(std::span<const StackedLoop> loops, const Eigen::VectorXd& delta) const;
  Eigen::VectorXd innovations_of(std::span<const StackedLoop> loops, const Stretch& stretch,
                                 const Eigen::VectorXd& delta) const;
  StackedJacobian jacobian_of(std::span<const StackedLoop> loops, const Stretch& stretch) const;
  void linearise(std::span<const StackedLoop> loops, const Eigen::VectorXd& delta, int iteration);
  void linearise_prior(std::span<const StackedLoop> loops);
  void narrow_to(std::span<const StackedLoop> loops);
  Eigen::MatrixXd picture_products() const;
  void multiply(std::span<const StackedLoop> loops);
  std::vector<bool> gate_loops(std::span<const StackedLoop> loops, UpdateReport& report) const;
  Outcome iterate(std::span<const StackedLoop> loops, UpdateReport& report);
  double largest_change(std::span<const StackedLoop> loops, const Eigen::VectorXd& change) const;
  double cost(std::span<const StackedLoop> loops, const Iterate& at) const;
  bool step_back(std::span<const StackedLoop> loops, const Iterate& from, Iterate& to) const;
  bool apply(const Iterate& end, int iterations);
  std::size_t first_of(std::span<const StackedLoop> loops) const;
  Eigen::Index begin_of(std::span<const StackedLoop> loops) const;
  void take_place(std::size_t motion, const StackedLoop& loop);
  void correct(const Eigen::VectorXd& dx);
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
  StateBlocks blocks_;
  std::vector<Pose> poses_;  ///< their composition
  MotionCovariance P_;
  Linearisation at_;  ///< the present one
  filter::Scratch V_;
  mutable std::vector<Eigen::Matrix3d> covariances_;  ///< of the poses; empty: to be computed
};

EstimatorEntry trajectory_iekf_entry();

}  // namespace fathom
