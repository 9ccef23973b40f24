#pragma once

#include <array>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <ceres/problem.h>

#include "estimators/ceres_pose_graph/ceres_pose_graph.hpp"
#include "fathom/estimation/precision.hpp"

namespace fathom {

/// The Ceres problem: one 3-vector block a keyframe, one EdgeCost a measurement; and where
/// registrations share errors of pictures, one more block a picture, n in units of σ.
class CeresPoseGraph::Graph {
 public:
  Graph(const Pose& origin, SolveMode mode, const CeresPoseGraphOptions& options);

  std::size_t size() const { return unknowns_.poses.size(); }
  Pose pose(std::size_t k) const;
  void set_poses(std::span<const Pose> poses);

  /// A keyframe at the newest one ⊕ the step.
  void add_keyframe(const RelativePose& step);
  void add_registration(const RelativePose& registration);
  /// As of RelativeEstimator.
  void bridge(const Bridge& bridge);
  /// Takes the last registrations back, down to `count` of them.
  void forget_registrations(std::size_t count);
  std::size_t registration_count() const { return registrations_.size(); }
  /// What one of them weighs under the loss, at the estimate.
  double registration_weight(std::size_t index) const;

  /// Solves from the present poses; keeps them as they were if it fails.
  UpdateReport solve();
  /// With a loss, of a whole graph: from the present poses and, if the loss holds the least squares
  /// of all for better than where that ends, from there too. Where steps are weak or missing dead
  /// reckoning is no place to begin.
  UpdateReport solve_robust();

  /// As of PredictedCovariances, from the joint covariance of their keyframes.
  std::optional<std::vector<Eigen::Matrix3d>> predicted_covariances(
      std::span<const RelativePose> forward_loops);

  /// Each as its innovation is to be tested: without the errors of its pictures as estimated.
  std::vector<RelativePose> without_errors(std::span<const RelativePose> registrations) const;

  std::optional<Eigen::Matrix3d> marginal(std::size_t k);

  /// As of Estimator.
  std::optional<Eigen::MatrixXd> joint_covariance(std::span<const std::size_t> keyframes);

  /// As of TrajectoryView.
  std::optional<std::vector<UncertainPose>> motions_to_newest();

 private:
  using Block = std::array<double, 3>;

  /// All unknowns.
  struct Unknowns {
    std::deque<Block> poses;  ///< a deque keeps the addresses that the problem knows
    std::deque<Block> errors;
  };

  double* block(std::size_t k) { return unknowns_.poses[k].data(); }
  /// The block of a picture's errors, made with its prior where there is none yet.
  double* errors(std::size_t keyframe);
  Eigen::Vector3d errors_at(std::size_t keyframe) const;
  /// Among the blocks of the Hessian; nothing where the picture has none.
  std::optional<std::size_t> errors_block(std::size_t keyframe) const;
  bool estimates_errors(const RelativePose& z) const;
  RelativePose without_errors(const RelativePose& z) const;
  ceres::ResidualBlockId add_residual(const RelativePose& z, ceres::LossFunction* loss);
  std::optional<std::vector<Eigen::Matrix3d>> predicted_with_errors(
      std::span<const RelativePose> forward_loops);
  bool is_finite() const;
  double cost();
  void restore(const Unknowns& unknowns);
  /// Which factorisation of the Jacobian: Cholesky of the sums JᵀJ, or QR, dense, for measurements
  /// that those sums do not carry.
  enum class Factors { sums, rows };
  UpdateReport solve_by(Factors factors);
  bool is_determined(Factors factors);
  /// Whether a Gauss-Newton step from here promises no more than the tolerance.
  bool is_at_minimum(Factors factors);
  /// All poses but the first, then the errors of pictures. There must be one pose: asked for
  /// nothing, Ceres takes all.
  ceres::Problem::EvaluateOptions free_blocks();
  void changed() { marginals_.reset(); }
  void compute_marginals();
  /// Null where it cannot be evaluated.
  std::unique_ptr<const Eigen::SparseMatrix<double>> jacobian();

  CeresPoseGraphOptions options_;
  bool is_batch_;
  bool is_plain_ = false;  ///< the loss is left out
  Unknowns unknowns_;
  std::vector<std::optional<std::size_t>> errors_of_;  ///< by keyframe, where it has some
  ceres::Problem problem_;
  struct Hole {
    RelativePose step;
    ceres::ResidualBlockId block;
  };
  std::map<std::size_t, Hole> holes_;  ///< by the keyframe after it
  std::vector<RelativePose> registrations_;
  std::vector<int> registration_ranks_;
  InformationSpread spread_;
  std::vector<ceres::ResidualBlockId> registration_blocks_;
  /// Of all keyframes; absent: to be computed, empty: could not be.
  std::optional<std::vector<Eigen::Matrix3d>> marginals_;
};

}  // namespace fathom
