#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "fathom/estimation/gate.hpp"
#include "fathom/estimation/relative_estimator.hpp"
#include "fathom/estimation/robust_loss.hpp"
#include "fathom/estimation/shared_error_model.hpp"
#include "fathom/estimation/used_loops.hpp"

namespace fathom {
namespace incremental_smoother {
class Smoother;
}  // namespace incremental_smoother

struct IncrementalSmootherOptions {
  int max_iterations = 100;
  double tolerance = 1e-5;
  double relinearise_m = 0.01;
  double relinearise_rad = 0.001;
  LossOptions loss;
  SharedErrorOptions shared;
  GateOptions gate;

  void describe(OptionTable& table);
  void check(const EstimatorSetup& setup) const;
};

/// Pose-graph least squares kept at its optimum from keyframe to keyframe: of a sparse factor in a
/// tree only what new registrations touch is eliminated again.
/// docs/estimators/incremental_smoother.md.
class IncrementalSmoother final : public RelativeEstimator {
 public:
  IncrementalSmoother(const EstimatorSetup& setup, const IncrementalSmootherOptions& options);
  ~IncrementalSmoother() override;

  void add_keyframe(const RelativePose& step) override;
  UpdateReport close_loops(std::span<const RelativePose> registrations) override;

  std::optional<LoopDecision> bridge(const Bridge& bridge) override;

  /// From the Gauss-Newton Hessian at the estimate, the loss applied as a weight; a rejected
  /// registration has no part in it.
  std::optional<Eigen::Matrix3d> covariance(std::size_t k) const override;
  std::optional<Eigen::MatrixXd> joint_covariance(
      std::span<const std::size_t> keyframes) const override;
  /// From the factor that the updates keep, in which every clique is linearised where it was within
  /// `relinearise_m` and `relinearise_rad`, and every loop weighs what it did within a tenth: costs
  /// what a gate costs.
  std::optional<Eigen::Matrix3d> newest_covariance() const override;
  std::optional<std::vector<UncertainPose>> motions_to_newest() const override;
  std::size_t size() const override;
  Pose pose(std::size_t k) const override;
  MovedPoses moved_since(std::uint64_t revision) const override;
  double loss(double chi2, int rank) const override { return loss_.of_rank(rank).at(chi2).rho; }
  std::vector<double> loop_weights() const override;
  bool estimates_shared_errors() const override {
    return shared_errors_ == SharedErrorModel::states;
  }

  const incremental_smoother::Smoother& smoother() const { return *smoother_; }

 private:
  RobustLoss loss_;
  SharedErrorModel shared_errors_;
  Gate gate_;
  UsedLoops used_loops_;
  std::unique_ptr<incremental_smoother::Smoother> smoother_;
  /// Of all keyframes; absent: to be computed, empty: could not be.
  mutable std::optional<std::vector<Eigen::Matrix3d>> marginals_;
};

EstimatorEntry incremental_smoother_entry();

}  // namespace fathom
