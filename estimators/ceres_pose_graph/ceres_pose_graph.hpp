#pragma once

#include <memory>
#include <vector>

#include "fathom/estimation/gate.hpp"
#include "fathom/estimation/relative_estimator.hpp"
#include "fathom/estimation/robust_loss.hpp"
#include "fathom/estimation/shared_error_model.hpp"
#include "fathom/estimation/used_loops.hpp"

namespace fathom {

struct CeresPoseGraphOptions {
  int max_iterations = 100;
  double tolerance = 1e-8;
  double initial_trust_region = 1e16;
  LossOptions loss;
  SharedErrorOptions shared;
  GateOptions gate;

  void describe(OptionTable& table);
  /// A batch solve has no innovation to gate.
  void check(const EstimatorSetup& setup) const;
};

/// Pose-graph least squares with Ceres: Levenberg-Marquardt over all keyframe poses, sparse
/// Cholesky of SuiteSparse. Incremental: warm-started whenever loops arrive.
/// docs/estimators/ceres_pose_graph.md.
class CeresPoseGraph final : public RelativeEstimator {
 public:
  CeresPoseGraph(const EstimatorSetup& setup, const CeresPoseGraphOptions& options);
  ~CeresPoseGraph() override;

  void add_keyframe(const RelativePose& step) override;
  UpdateReport close_loops(std::span<const RelativePose> registrations) override;
  UpdateReport finish(std::span<const Pose> start) override;
  std::optional<LoopDecision> bridge(const Bridge& bridge) override;

  /// From the Gauss-Newton Hessian at the estimate, the loss applied as a weight; a rejected
  /// registration has no part in it.
  std::optional<Eigen::Matrix3d> covariance(std::size_t k) const override;
  std::optional<Eigen::MatrixXd> joint_covariance(
      std::span<const std::size_t> keyframes) const override;
  /// From that same Hessian.
  std::optional<std::vector<UncertainPose>> motions_to_newest() const override;
  double loss(double chi2, int rank) const override { return loss_.of_rank(rank).at(chi2).rho; }
  std::vector<double> loop_weights() const override;
  bool estimates_shared_errors() const override {
    return options_.shared.model == SharedErrorModel::states;
  }
  std::size_t size() const override;
  Pose pose(std::size_t k) const override;

 private:
  class Graph;  // keeps Ceres out of this header

  UpdateReport minimise_with(std::span<const RelativePose> registrations);

  CeresPoseGraphOptions options_;
  SolveMode mode_;
  RobustLoss loss_;
  Gate gate_;
  UsedLoops used_loops_;
  std::unique_ptr<Graph> graph_;
};

EstimatorEntry ceres_pose_graph_entry();

}  // namespace fathom
