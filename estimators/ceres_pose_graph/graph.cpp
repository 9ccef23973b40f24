#include "estimators/ceres_pose_graph/graph.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

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
  CeresLoss(const RobustLoss& loss, const bool& is_plain) : loss_(loss), is_plain_(is_plain) {}

  void Evaluate(double s, double rho[3]) const override {
    const LossValue value = is_plain_ ? LossValue{s} : loss_.at(s);
    rho[0] = value.rho;
    rho[1] = value.weight;
    rho[2] = value.curvature;
  }

 private:
  RobustLoss loss_;
  const bool& is_plain_;
};

ceres::LossFunction* make_loss(const CeresPoseGraphOptions& options, int rank,
                               const bool& is_plain) {
  const RobustLoss loss = RobustLoss(options.loss).of_rank(rank);
  return loss.is_on() ? new CeresLoss(loss, is_plain) : nullptr;
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
  // Down to the least trust region, and then is_at_minimum decides.
  solver.max_num_consecutive_invalid_steps = options.max_iterations;
  solver.num_threads = 1;
  solver.logging_type = ceres::SILENT;
  return solver;
}

// The damping of a trust region is a share of the columns of the Jacobian, which have the heaviest
// measurements: it has to be below what the lightest say.
void solve_with_rows(ceres::Solver::Options& solver) {
  constexpr double kRadius = 1e30;
  solver.linear_solver_type = ceres::DENSE_QR;
  solver.initial_trust_region_radius = kRadius;
  solver.max_trust_region_radius = kRadius;
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

CeresPoseGraph::Graph::Graph(const Pose& origin, SolveMode mode,
                             const CeresPoseGraphOptions& options)
    : options_(options), is_batch_(mode == SolveMode::batch), problem_(problem_options()) {
  unknowns_.poses.push_back({origin.x, origin.y, origin.theta});
  problem_.AddParameterBlock(block(0), 3);
  problem_.SetParameterBlockConstant(block(0));
}

Pose CeresPoseGraph::Graph::pose(std::size_t k) const {
  return {unknowns_.poses[k][0], unknowns_.poses[k][1], wrap_angle(unknowns_.poses[k][2])};
}

void CeresPoseGraph::Graph::set_poses(std::span<const Pose> poses) {
  for (std::size_t k = 1; k < size(); ++k) {
    unknowns_.poses[k] = {poses[k].x, poses[k].y, poses[k].theta};
  }
  std::ranges::fill(unknowns_.errors, Block{});
  changed();
}

void CeresPoseGraph::Graph::add_keyframe(const RelativePose& step) {
  const Pose next = compose(pose(size() - 1), step.forward().motion);
  unknowns_.poses.push_back({next.x, next.y, next.theta});
  if (is_batch_ && step.is_hole) {
    problem_.AddParameterBlock(block(size() - 1), 3);
  } else {
    spread_.add(step);
    const auto residual =
        problem_.AddResidualBlock(new EdgeCost(step), nullptr, block(step.from), block(step.to));
    if (step.is_hole) holes_[size() - 1] = {step.forward(), residual};
  }
  changed();
}

// The steps of holes, of which nothing is measured, follow: F stays.
void CeresPoseGraph::Graph::bridge(const Bridge& bridge) {
  for (std::size_t k = 0; k < size(); ++k) {
    if (!bridge.moves[k]) continue;
    const Pose moved = compose(bridge.motion, pose(k));
    unknowns_.poses[k] = {moved.x, moved.y, moved.theta};
  }
  for (const std::size_t node : bridge.holes) {
    if (bridge.moves[node - 1] == bridge.moves[node]) continue;
    Hole& hole = holes_.at(node);
    problem_.RemoveResidualBlock(hole.block);
    hole.step.motion = between(pose(node - 1), pose(node));
    hole.block =
        problem_.AddResidualBlock(new EdgeCost(hole.step), nullptr, block(node - 1), block(node));
  }
  changed();
}

void CeresPoseGraph::Graph::add_registration(const RelativePose& registration) {
  const int rank = rank_of(registration.information);
  registration_blocks_.push_back(add_residual(registration, make_loss(options_, rank, is_plain_)));
  registrations_.push_back(registration);
  registration_ranks_.push_back(rank);
  spread_.add(registration);
  changed();
}

double CeresPoseGraph::Graph::registration_weight(std::size_t index) const {
  const RelativePose z = without_errors(registrations_[index]);
  const RobustLoss loss = RobustLoss(options_.loss).of_rank(registration_ranks_[index]);
  return loss.weight(chi2(z, pose(z.from), pose(z.to)));
}

void CeresPoseGraph::Graph::forget_registrations(std::size_t count) {
  while (registrations_.size() > count) {
    problem_.RemoveResidualBlock(registration_blocks_.back());
    registration_blocks_.pop_back();
    registrations_.pop_back();
    registration_ranks_.pop_back();
  }
  changed();
}

bool CeresPoseGraph::Graph::is_finite() const {
  const auto is_block_finite = [](const Block& block) {
    return std::ranges::all_of(block, [](double v) { return std::isfinite(v); });
  };
  return std::ranges::all_of(unknowns_.poses, is_block_finite) &&
         std::ranges::all_of(unknowns_.errors, is_block_finite);
}

UpdateReport CeresPoseGraph::Graph::solve() {
  const Unknowns before = unknowns_;
  UpdateReport report = solve_by(Factors::sums);
  const auto columns = static_cast<Eigen::Index>(3 * (size() - 1 + unknowns_.errors.size()));
  if (!is_done(report.outcome) && spread_.is_wide() && columns <= kMostDenseColumns) {
    restore(before);
    const int iterations = report.iterations;
    report = solve_by(Factors::rows);
    report.iterations += iterations;
  }
  if (!is_done(report.outcome)) restore(before);
  return report;
}

UpdateReport CeresPoseGraph::Graph::solve_by(Factors factors) {
  UpdateReport report;
  ceres::Solver::Options solver = solver_options(options_);
  if (factors == Factors::rows) solve_with_rows(solver);
  ceres::Solver::Summary summary;
  const BlasMemory memory;  // CHOLMOD's supernodes are products of BLAS
  ceres::Solve(solver, &problem_, &summary);
  report.iterations = summary.num_successful_steps + summary.num_unsuccessful_steps;
  report.outcome = outcome_of(summary);
  if (summary.iterations.size() > 1 && !summary.iterations.back().step_is_valid) {
    report.outcome = is_at_minimum(factors) ? Outcome::converged : Outcome::numerical_failure;
  }
  if (!is_finite() || !is_determined(factors)) report.outcome = Outcome::numerical_failure;
  changed();
  return report;
}

double CeresPoseGraph::Graph::cost() {
  double cost = std::numeric_limits<double>::infinity();
  problem_.Evaluate({}, &cost, nullptr, nullptr, nullptr);
  return cost;
}

void CeresPoseGraph::Graph::restore(const Unknowns& unknowns) {
  std::ranges::copy(unknowns.poses, unknowns_.poses.begin());
  std::ranges::copy(unknowns.errors, unknowns_.errors.begin());
  changed();
}

UpdateReport CeresPoseGraph::Graph::solve_robust() {
  const Unknowns start = unknowns_;
  const UpdateReport given = solve();
  const Unknowns reached = unknowns_;
  const double least = cost();
  restore(start);
  is_plain_ = true;
  const int plain_iterations = solve().iterations;
  is_plain_ = false;
  if (!is_done(given.outcome) || cost() < least) {
    UpdateReport report = solve();
    report.iterations += given.iterations + plain_iterations;
    if (is_done(report.outcome) && (!is_done(given.outcome) || cost() < least)) return report;
  }
  restore(reached);
  return given;
}

}  // namespace fathom
