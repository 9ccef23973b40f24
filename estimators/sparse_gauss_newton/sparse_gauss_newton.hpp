#pragma once

#include <memory>

#include "fathom/estimation/estimator.hpp"
#include "fathom/estimation/gate.hpp"
#include "fathom/estimation/registry.hpp"

namespace fathom {
namespace sparse_gauss_newton {
enum class Start;
class Graph;
}  // namespace sparse_gauss_newton

struct SparseGaussNewtonOptions {
  int max_iterations = 100;
  double tolerance = 1e-8;
  sparse_gauss_newton::Start start{};  ///< automatic
  GateOptions gate;

  void describe(OptionTable& table);
  /// A batch solve has no innovation to gate; an incremental one always starts where it is.
  void check(const EstimatorSetup& setup) const;
};

/// Pose-graph least squares by Gauss-Newton and Newton steps on a sparse block Cholesky
/// factorisation of its own. Incremental: warm-started whenever loops arrive. Batch: finds its
/// start by itself. docs/estimators/sparse_gauss_newton.md.
class SparseGaussNewton final : public Estimator {
 public:
  SparseGaussNewton(const EstimatorSetup& setup, const SparseGaussNewtonOptions& options);
  ~SparseGaussNewton() override;

  void add_keyframe(const RelativePose& step) override;
  UpdateReport close_loops(std::span<const RelativePose> registrations) override;
  UpdateReport finish(std::span<const Pose> start) override;

  /// From the Gauss-Newton Hessian at the estimate; a rejected registration has no part in it.
  std::optional<Eigen::Matrix3d> covariance(std::size_t k) override;
  std::optional<std::vector<UncertainPose>> motions_to_newest() const override;
  std::size_t size() const override;
  Pose pose(std::size_t k) const override;

 private:
  bool judge(std::span<const RelativePose> registrations, UpdateReport& report);

  SparseGaussNewtonOptions options_;
  SolveMode mode_;
  Gate gate_;
  std::unique_ptr<sparse_gauss_newton::Graph> graph_;
};

EstimatorEntry sparse_gauss_newton_entry();

}  // namespace fathom
