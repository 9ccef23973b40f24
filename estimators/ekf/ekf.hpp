#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimators/support/filter/packed_covariance.hpp"
#include "fathom/estimation/gate.hpp"
#include "fathom/estimation/loop_rows.hpp"
#include "fathom/estimation/relative_estimator.hpp"

namespace fathom {

/// `max_iterations` and `tolerance` are keys that every estimator's configuration shares, so that
/// changing the back end is changing one word. One linearisation is within any limit, and there is
/// nothing that a tolerance could end.
struct EkfOptions {
  int max_iterations = 1;
  double tolerance = 1e-6;
  /// Of the cost before the update, or of 1: below it a χ² is good whatever it was. An update that
  /// helps lowers the cost; ten times as much is no linearisation error.
  double divergence_factor = 10.0;
  GateOptions gate;

  void describe(OptionTable& table);
};

/// The plain delayed-state EKF: the state is the stack of absolute keyframe poses 1 … n (keyframe 0
/// is fixed and has no entry), each update linearised once. docs/estimators/ekf.md.
class Ekf final : public RelativeEstimator {
 public:
  Ekf(const EstimatorSetup& setup, const EkfOptions& options);

  void add_keyframe(const RelativePose& step) override;
  UpdateReport close_loops(std::span<const RelativePose> registrations) override;
  std::optional<LoopDecision> bridge(const Bridge& bridge) override;
  std::optional<Eigen::Matrix3d> covariance(std::size_t k) const override;
  std::optional<Eigen::MatrixXd> joint_covariance(
      std::span<const std::size_t> keyframes) const override;
  std::size_t size() const override { return poses_.size(); }
  Pose pose(std::size_t k) const override { return poses_[k]; }
  /// From the joint blocks of both keyframes.
  std::optional<std::vector<UncertainPose>> motions_to_newest() const override;
  /// P of the whole state.
  const filter::PackedCovariance& state_covariance() const { return P_; }

 private:
  /// One loop against the present state: ν = z − h(x), h = ⊖X_from ⊕ X_to, and of a semi-definite
  /// one the rows that it measures.
  struct Innovation {
    std::size_t from = 0;
    std::size_t to = 0;
    Pose motion;
    LoopRows rows;
    Eigen::Vector3d nu;
    Eigen::Matrix3d H_from;
    Eigen::Matrix3d H_to;
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

  /// Block of keyframe k in the state; keyframe 0 has none.
  static Eigen::Index block_of(std::size_t k) { return static_cast<Eigen::Index>(k) - 1; }

  Innovation innovate(const RelativePose& z) const;
  LoopDecision decide(const Innovation& z) const;
  /// What the covariance of two poses has beyond its block of P: of one floating part.
  Eigen::Matrix3d spread_of(std::size_t k, std::size_t l) const;
  /// The poses of a floating part are in P as they are known, from now on.
  void settle(std::size_t part);
  /// The nodes that move, and the rows and columns of their covariance.
  void move(const Bridge& bridge, Eigen::MatrixXd& P);
  Eigen::MatrixX3d covariance_times_transposed(const Innovation& innovation) const;
  static Eigen::MatrixXd projected(std::span<const Innovation> stack, const Eigen::MatrixXd& PHt);
  Eigen::Vector3d innovation_of(const Innovation& z) const;
  Stack stack(std::span<const Innovation> loops) const;
  void gate_together(std::vector<Innovation>& accepted, UpdateReport& report) const;
  Outcome update(std::span<const Innovation> accepted);

  double divergence_factor_;
  Gate gate_;
  std::vector<Pose> poses_;
  filter::PackedCovariance P_;
  std::vector<Floating> floating_;
  std::vector<std::size_t> part_of_{0};  ///< 0, or 1 + the index of its floating part
};

EstimatorEntry ekf_entry();

}  // namespace fathom
