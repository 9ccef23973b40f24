#include "estimators/ceres_pose_graph/graph.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <ceres/covariance.h>
#include <ceres/loss_function.h>
#include <ceres/solver.h>

#include "estimators/ceres_pose_graph/edge_cost.hpp"
#include "fathom/geometry/covariance.hpp"

namespace fathom {
namespace {

using RowMajorMatrix3d = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
using Loss = CeresPoseGraphOptions::Loss;

ceres::LossFunction* make_loss(const CeresPoseGraphOptions& options) {
  switch (options.loss) {
    case Loss::huber:
      return new ceres::HuberLoss(options.loss_scale);
    case Loss::cauchy:
      return new ceres::CauchyLoss(options.loss_scale);
    case Loss::none:
      break;
  }
  return nullptr;
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

ceres::Covariance::Options covariance_options() {
  ceres::Covariance::Options options;
  options.algorithm_type = ceres::SPARSE_QR;
  options.sparse_linear_algebra_library_type = ceres::SUITE_SPARSE;
  options.num_threads = 1;
  return options;
}

}  // namespace

CeresPoseGraph::Graph::Graph(const Pose& origin, const CeresPoseGraphOptions& options)
    : options_(options) {
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
  problem_.AddResidualBlock(new EdgeCost(step), nullptr, block(step.from), block(step.to));
  changed();
}

void CeresPoseGraph::Graph::add_registration(const RelativePose& registration) {
  problem_.AddResidualBlock(new EdgeCost(registration), make_loss(options_),
                            block(registration.from), block(registration.to));
  changed();
}

UpdateReport CeresPoseGraph::Graph::solve() {
  UpdateReport report;
  const std::deque<Block> before = poses_;
  ceres::Solver::Summary summary;
  ceres::Solve(solver_options(options_), &problem_, &summary);
  report.iterations = summary.num_successful_steps + summary.num_unsuccessful_steps;
  report.outcome = outcome_of(summary);
  bool finite = true;
  for (const Block& pose : poses_) {
    finite =
        finite && std::all_of(pose.begin(), pose.end(), [](double v) { return std::isfinite(v); });
  }
  if (!finite) report.outcome = Outcome::numerical_failure;
  if (!is_done(report.outcome)) std::copy(before.begin(), before.end(), poses_.begin());
  changed();
  return report;
}

std::optional<std::vector<Eigen::Matrix3d>> CeresPoseGraph::Graph::innovation_covariances(
    std::span<const RelativePose> forward_loops) {
  std::vector<BlockPair> pairs{{block(size() - 1), block(size() - 1)}};
  for (const RelativePose& z : forward_loops) {
    if (z.from == 0) continue;
    pairs.emplace_back(block(z.from), block(z.from));
    pairs.emplace_back(block(z.from), block(z.to));
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  ceres::Covariance covariance(covariance_options());
  if (!covariance.Compute(pairs, &problem_)) return std::nullopt;

  const auto joint = [&](std::size_t a, std::size_t b) -> Eigen::Matrix3d {
    RowMajorMatrix3d value = RowMajorMatrix3d::Zero();
    if (a > 0 && b > 0) covariance.GetCovarianceBlock(block(a), block(b), value.data());
    return value;
  };
  std::vector<Eigen::Matrix3d> innovations;
  for (const RelativePose& z : forward_loops) {
    Eigen::Matrix3d H_from;
    Eigen::Matrix3d H_to;
    between(pose(z.from), pose(z.to), &H_from, &H_to);
    const Eigen::Matrix3d cross = H_from * joint(z.from, z.to) * H_to.transpose();
    innovations.push_back(transport(H_from, joint(z.from, z.from)) +
                          transport(H_to, joint(z.to, z.to)) + cross + cross.transpose() +
                          z.covariance());
  }
  return innovations;
}

bool CeresPoseGraph::Graph::compute_marginals() {
  marginals_.emplace();
  std::vector<BlockPair> pairs;
  for (std::size_t k = 1; k < size(); ++k) pairs.emplace_back(block(k), block(k));
  ceres::Covariance covariance(covariance_options());
  if (!pairs.empty() && !covariance.Compute(pairs, &problem_)) return false;
  marginals_->push_back(Eigen::Matrix3d::Zero());
  for (std::size_t k = 1; k < size(); ++k) {
    RowMajorMatrix3d value;
    covariance.GetCovarianceBlock(block(k), block(k), value.data());
    marginals_->push_back(value);
  }
  return true;
}

std::optional<Eigen::Matrix3d> CeresPoseGraph::Graph::marginal(std::size_t k) {
  if (!marginals_) compute_marginals();
  if (marginals_->empty()) return std::nullopt;
  return (*marginals_)[k];
}

}  // namespace fathom
