#include "estimators/ceres_pose_graph/graph.hpp"

#include <algorithm>
#include <cmath>

#include <ceres/crs_matrix.h>
#include <ceres/loss_function.h>
#include <ceres/solver.h>

#include "estimators/ceres_pose_graph/edge_cost.hpp"
#include "estimators/ceres_pose_graph/hessian_inverse.hpp"
#include "fathom/core/blas_memory.hpp"
#include "fathom/estimation/joint_covariance.hpp"
#include "fathom/geometry/covariance.hpp"

namespace fathom {
namespace {

// A loss as Ceres asks for it: ρ, ρ' and ρ'' of s.
class CeresLoss final : public ceres::LossFunction {
 public:
  explicit CeresLoss(const RobustLoss& loss) : loss_(loss) {}

  void Evaluate(double s, double rho[3]) const override {
    const LossValue value = loss_.at(s);
    rho[0] = value.rho;
    rho[1] = value.weight;
    rho[2] = value.curvature;
  }

 private:
  RobustLoss loss_;
};

ceres::LossFunction* make_loss(const CeresPoseGraphOptions& options) {
  const RobustLoss loss(options.loss);
  return loss.is_on() ? new CeresLoss(loss) : nullptr;
}

// Its checks look each block up in a tree, for overlaps: here they are elements of one deque, and a
// measurement is of two different keyframes.
ceres::Problem::Options problem_options() {
  ceres::Problem::Options problem;
  problem.disable_all_safety_checks = true;
  return problem;
}

ceres::Solver::Options solver_options(const CeresPoseGraphOptions& options) {
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  solver.sparse_linear_algebra_library_type = ceres::SUITE_SPARSE;
  solver.max_num_iterations = options.max_iterations;
  solver.function_tolerance = options.tolerance;
  solver.parameter_tolerance = options.tolerance;
  solver.gradient_tolerance = 1e-4 * options.tolerance;
  solver.initial_trust_region_radius = options.initial_trust_region;
  solver.max_trust_region_radius = std::max(1e16, options.initial_trust_region);
  solver.num_threads = 1;
  solver.logging_type = ceres::SILENT;
  return solver;
}

Outcome outcome_of(const ceres::Solver::Summary& summary) {
  switch (summary.termination_type) {
    case ceres::CONVERGENCE:
      return Outcome::converged;
    case ceres::NO_CONVERGENCE:
      return Outcome::iteration_limit;
    default:
      return Outcome::numerical_failure;
  }
}

}  // namespace

CeresPoseGraph::Graph::Graph(const Pose& origin, const CeresPoseGraphOptions& options)
    : options_(options), problem_(problem_options()) {
  poses_.push_back({origin.x, origin.y, origin.theta});
  problem_.AddParameterBlock(block(0), 3);
  problem_.SetParameterBlockConstant(block(0));
}

Pose CeresPoseGraph::Graph::pose(std::size_t k) const {
  return {poses_[k][0], poses_[k][1], wrap_angle(poses_[k][2])};
}

void CeresPoseGraph::Graph::set_poses(std::span<const Pose> poses) {
  for (std::size_t k = 1; k < poses_.size(); ++k) {
    poses_[k] = {poses[k].x, poses[k].y, poses[k].theta};
  }
  changed();
}

void CeresPoseGraph::Graph::add_keyframe(const RelativePose& step) {
  const Pose next = compose(pose(size() - 1), step.forward().motion);
  poses_.push_back({next.x, next.y, next.theta});
  spread_.add(step);
  problem_.AddResidualBlock(new EdgeCost(step), nullptr, block(step.from), block(step.to));
  changed();
}

void CeresPoseGraph::Graph::add_registration(const RelativePose& registration) {
  registration_blocks_.push_back(
      problem_.AddResidualBlock(new EdgeCost(registration), make_loss(options_),
                                block(registration.from), block(registration.to)));
  registrations_.push_back(registration);
  spread_.add(registration);
  changed();
}

double CeresPoseGraph::Graph::registration_chi2(std::size_t index) const {
  const RelativePose& z = registrations_[index];
  return chi2(z, pose(z.from), pose(z.to));
}

void CeresPoseGraph::Graph::forget_registrations(std::size_t count) {
  while (registrations_.size() > count) {
    problem_.RemoveResidualBlock(registration_blocks_.back());
    registration_blocks_.pop_back();
    registrations_.pop_back();
  }
  changed();
}

bool CeresPoseGraph::Graph::is_finite() const {
  return std::all_of(poses_.begin(), poses_.end(), [](const Block& pose) {
    return std::all_of(pose.begin(), pose.end(), [](double v) { return std::isfinite(v); });
  });
}

// Measurements that are alike in their information always are.
bool CeresPoseGraph::Graph::is_determined() {
  if (!spread_.is_wide()) return true;
  const auto H = hessian();
  return H && fathom::is_determined(*H);
}

UpdateReport CeresPoseGraph::Graph::solve() {
  UpdateReport report;
  const std::deque<Block> before = poses_;
  ceres::Solver::Summary summary;
  const BlasMemory memory;  // CHOLMOD's supernodes are products of BLAS
  ceres::Solve(solver_options(options_), &problem_, &summary);
  report.iterations = summary.num_successful_steps + summary.num_unsuccessful_steps;
  report.outcome = outcome_of(summary);
  if (!is_finite() || !is_determined()) report.outcome = Outcome::numerical_failure;
  if (!is_done(report.outcome)) std::copy(before.begin(), before.end(), poses_.begin());
  changed();
  return report;
}

std::optional<std::vector<Eigen::Matrix3d>> CeresPoseGraph::Graph::innovation_covariances(
    std::span<const RelativePose> forward_loops) {
  std::vector<std::size_t> ends;
  for (const RelativePose& z : forward_loops) ends.insert(ends.end(), {z.from, z.to});
  const auto joint = joint_covariance(ends);
  if (!joint) return std::nullopt;
  std::vector<Eigen::Matrix3d> innovations;
  for (const RelativePose& z : forward_loops) {
    const auto row = static_cast<Eigen::Index>(6 * innovations.size());
    const PairCovariance pair{joint->block<3, 3>(row, row), joint->block<3, 3>(row + 3, row + 3),
                              joint->block<3, 3>(row, row + 3)};
    innovations.push_back(between(pose(z.from), pose(z.to), pair).covariance + z.covariance());
  }
  return innovations;
}

void CeresPoseGraph::Graph::compute_marginals() {
  marginals_.emplace();
  if (size() > 1) {
    const auto H = hessian();
    const auto blocks = H ? inverse_blocks(*H) : std::nullopt;
    if (!blocks) return;
    *marginals_ = blocks->own;
  }
  marginals_->insert(marginals_->begin(), Eigen::Matrix3d::Zero());
}

std::optional<Eigen::Matrix3d> CeresPoseGraph::Graph::marginal(std::size_t k) {
  if (!marginals_) compute_marginals();
  if (marginals_->empty()) return std::nullopt;
  return (*marginals_)[k];
}

std::optional<Eigen::MatrixXd> CeresPoseGraph::Graph::joint_covariance(
    std::span<const std::size_t> keyframes) {
  std::vector<std::size_t> blocks = free_keyframes(keyframes);
  if (blocks.empty()) return in_order_of(keyframes, {});
  for (std::size_t& block : blocks) --block;  // of the Hessian, which has none for keyframe 0
  const auto H = hessian();
  const auto joint = H ? inverse_between(*H, blocks) : std::nullopt;
  if (!joint) return std::nullopt;
  return in_order_of(keyframes, *joint);
}

// The Hessian of the poses but the first, which is fixed, the loss applied as a weight. There must
// be one: asked for no poses, Ceres takes all. Nothing where it is not finite, of which
// Ceres would print a warning.
std::unique_ptr<const Eigen::SparseMatrix<double>> CeresPoseGraph::Graph::hessian() {
  if (!is_finite()) return nullptr;
  ceres::Problem::EvaluateOptions evaluate;
  evaluate.num_threads = 1;
  for (std::size_t k = 1; k < size(); ++k) evaluate.parameter_blocks.push_back(block(k));
  ceres::CRSMatrix J;
  if (!problem_.Evaluate(evaluate, nullptr, nullptr, nullptr, &J)) return nullptr;
  const Eigen::SparseMatrix<double> by_columns =
      Eigen::Map<const Eigen::SparseMatrix<double, Eigen::RowMajor>>(
          J.num_rows, J.num_cols, static_cast<Eigen::Index>(J.values.size()), J.rows.data(),
          J.cols.data(), J.values.data());
  return std::make_unique<const Eigen::SparseMatrix<double>>(by_columns.transpose() * by_columns);
}

std::optional<std::vector<UncertainPose>> CeresPoseGraph::Graph::motions_to_newest() {
  std::vector<UncertainPose> motions;
  const std::size_t n = size() - 1;
  if (n == 0) return motions;
  const auto H = hessian();
  const auto blocks = H ? inverse_blocks(*H) : std::nullopt;
  if (!blocks) return std::nullopt;
  PairCovariance pair;
  pair.B = blocks->own[n - 1];
  for (std::size_t k = 0; k < n; ++k) {
    if (k > 0) {
      pair.A = blocks->own[k - 1];
      pair.cross = blocks->with_last[k - 1];
    }
    motions.push_back(between(pose(k), pose(n), pair));
  }
  return motions;
}

}  // namespace fathom
