#pragma once

#include <memory>
#include <vector>

#include "estimators/sparse_gauss_newton/robust.hpp"
#include "fathom/estimation/gate.hpp"
#include "fathom/estimation/relative_estimator.hpp"
#include "fathom/estimation/robust_loss.hpp"
#include "fathom/estimation/shared_error_model.hpp"
#include "fathom/estimation/used_loops.hpp"

namespace fathom {
namespace sparse_gauss_newton {
class Graph;
}

struct SparseGaussNewtonOptions {
  int max_iterations = 100;
  double tolerance = 1e-8;
  pose_graph::Start start = pose_graph::Start::automatic;
  LossOptions loss;
  sparse_gauss_newton::Graduation graduation = sparse_gauss_newton::Graduation::off;
  sparse_gauss_newton::LoopJudgement truncated;
  SharedErrorOptions shared;
  GateOptions gate;
  int threads = 1;

  void describe(OptionTable& table);
  /// A batch solve has no innovation to gate; an incremental one always starts where it is, and so
  /// does one with a loss: headings by linear least squares would follow false loops.
  void check(const EstimatorSetup& setup) const;
};

/// Pose-graph least squares by Gauss-Newton and Newton steps on a sparse block Cholesky
/// factorisation of its own. Incremental: warm-started whenever loops arrive. Batch: finds its
/// start by itself. docs/estimators/sparse_gauss_newton.md.
class SparseGaussNewton final : public RelativeEstimator {
 public:
  SparseGaussNewton(const EstimatorSetup& setup, const SparseGaussNewtonOptions& options);
  ~SparseGaussNewton() override;

  void add_keyframe(const RelativePose& step) override;
  UpdateReport close_loops(std::span<const RelativePose> registrations) override;
  UpdateReport finish(std::span<const Pose> start) override;
  std::optional<LoopDecision> bridge(const Bridge& bridge) override;

  /// From the Gauss-Newton Hessian at the estimate, the loss applied as a weight; a rejected
  /// registration has no part in it.
  std::optional<Eigen::Matrix3d> covariance(std::size_t k) const override;
  std::optional<Eigen::MatrixXd> joint_covariance(
      std::span<const std::size_t> keyframes) const override;
  std::optional<std::vector<UncertainPose>> motions_to_newest() const override;
  std::size_t size() const override;
  Pose pose(std::size_t k) const override;
  double loss(double chi2, int rank) const override;
  std::vector<double> loop_weights() const override;
  bool estimates_shared_errors() const override {
    return options_.shared.model == SharedErrorModel::states;
  }

 private:
  pose_graph::SolveResult solve(pose_graph::Start start);
  UpdateReport minimise_with(std::span<const RelativePose> registrations);

  SparseGaussNewtonOptions options_;
  SolveMode mode_;
  RobustLoss loss_;
  Gate gate_;
  UsedLoops used_loops_;
  std::unique_ptr<sparse_gauss_newton::Graph> graph_;
};

EstimatorEntry sparse_gauss_newton_entry();

}  // namespace fathom
