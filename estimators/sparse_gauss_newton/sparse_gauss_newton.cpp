#include "estimators/sparse_gauss_newton/sparse_gauss_newton.hpp"

#include <algorithm>
#include <vector>

#include "estimators/sparse_gauss_newton/graph.hpp"

namespace fathom {
namespace {

using sparse_gauss_newton::Graduation;
using sparse_gauss_newton::RobustOptions;
using sparse_gauss_newton::SolveLimits;
using sparse_gauss_newton::SolveResult;
using sparse_gauss_newton::Start;

// More are a slip of the hand.
constexpr int kMostThreads = 1024;

UpdateReport report_of(const SolveResult& result) {
  UpdateReport report;
  report.outcome = result.outcome;
  report.iterations = result.iterations;
  report.gradient_norm = result.gradient_norm;
  report.is_local_minimum = result.is_local_minimum;
  return report;
}

RobustOptions robust_options(const SparseGaussNewtonOptions& options) {
  RobustOptions robust{RobustLoss(options.loss), std::nullopt, options.graduation,
                       options.truncated};
  if (options.loss.scale) robust.squared_scale = *options.loss.scale * *options.loss.scale;
  return robust;
}

}  // namespace

void SparseGaussNewtonOptions::describe(OptionTable& table) {
  table.integer("max_iterations", max_iterations, Range::at_least(1), "",
                "linearisations of one solve at most, from each start that it tries");
  table.real("tolerance", tolerance, Range::positive(), "",
             "a solve has converged when cost or poses change by a smaller share");
  table.enumeration("start", start,
                    {{"auto", Start::automatic},
                     {"given", Start::given},
                     {"lago", Start::lago},
                     {"chordal", Start::chordal},
                     {"lifted", Start::lifted}},
                    "batch: where a solve starts; given is --init, the others make headings first");
  loss.describe(table, true);
  table.enumeration(
      "graduation", graduation, {{"off", Graduation::off}, {"convex", Graduation::convex}},
      "geman_mcclure, truncated: from where graduated non-convexity leads to the loss");
  table.group("truncated", truncated);
  shared.describe(table);
  gate.describe(table);
  table.integer("threads", threads, Range::between(1, kMostThreads), "",
                "threads that solve a large graph; the result is the same for any number");
}

void SparseGaussNewtonOptions::check(const EstimatorSetup& setup) const {
  const bool batch = setup.mode == SolveMode::batch;
  if (batch && gate.probability) {
    throw InputError(
        "gate_probability: a batch solve has no innovation to gate; use the incremental mode");
  }
  loss.check();
  const bool graduates = loss.kind == LossKind::geman_mcclure || loss.kind == LossKind::truncated;
  if (graduation != Graduation::off && !graduates) {
    throw InputError("graduation: only loss geman_mcclure and truncated have one");
  }
  if (loss.kind != LossKind::truncated && truncated != sparse_gauss_newton::LoopJudgement{}) {
    throw InputError("truncated: its options are those of loss truncated; set loss too");
  }
  if (loss.kind != LossKind::none && start != Start::automatic && start != Start::given) {
    throw InputError(
        "start: with a loss a solve starts where it is given; headings by least squares would "
        "follow false loops");
  }
  if (!batch && start != Start::automatic) {
    throw InputError(
        "start: only a batch solve has one; the incremental mode starts from its estimate");
  }
}

SparseGaussNewton::SparseGaussNewton(const EstimatorSetup& setup,
                                     const SparseGaussNewtonOptions& options)
    : options_(options),
      mode_(setup.mode),
      loss_(options.loss),
      gate_(options.gate),
      graph_(std::make_unique<sparse_gauss_newton::Graph>(
          setup, robust_options(options), options.shared.model, gate_.is_on(), options.threads)) {}

SparseGaussNewton::~SparseGaussNewton() = default;

std::size_t SparseGaussNewton::size() const {
  return graph_->size();
}

Pose SparseGaussNewton::pose(std::size_t k) const {
  return graph_->pose(k);
}

void SparseGaussNewton::add_keyframe(const RelativePose& step) {
  graph_->add_keyframe(step);
}

UpdateReport SparseGaussNewton::close_loops(std::span<const RelativePose> registrations) {
  UpdateReport report = judged_update(
      gate_, *this, registrations,
      [this](auto forward) { return graph_->predicted_covariances(forward); },
      [this](auto used) { return minimise_with(used); },
      gate_.is_on() ? graph_->without_errors(registrations) : std::vector<RelativePose>());
  used_loops_.note(report);
  return report;
}

UpdateReport SparseGaussNewton::minimise_with(std::span<const RelativePose> registrations) {
  const std::size_t before = graph_->edge_count();
  for (const RelativePose& z : registrations) graph_->add_registration(z);
  if (mode_ == SolveMode::batch) return {};
  const UpdateReport solved = report_of(solve(Start::given));
  if (!is_done(solved.outcome)) graph_->forget_edges(before);
  return solved;
}

SolveResult SparseGaussNewton::solve(Start start) {
  const SolveLimits limits{options_.max_iterations, options_.tolerance};
  if (!loss_.is_on()) return graph_->solve(start, limits);
  return graph_->solve_robust(limits, mode_ == SolveMode::batch);
}

double SparseGaussNewton::loss(double chi2, int rank) const {
  const auto& adapted = graph_->squared_scales();
  return adapted ? std::min(chi2, adapted->of_rank(rank)) : loss_.of_rank(rank).at(chi2).rho;
}

std::vector<double> SparseGaussNewton::loop_weights() const {
  return used_loops_.weights(graph_->registration_weights());
}

UpdateReport SparseGaussNewton::finish(std::span<const Pose> start) {
  if (mode_ != SolveMode::batch || graph_->size() < 2) return {};
  if (!start.empty()) graph_->set_poses(start);
  return report_of(solve(options_.start));
}

std::optional<LoopDecision> SparseGaussNewton::bridge(const Bridge& bridge) {
  graph_->bridge(bridge);
  return std::nullopt;
}

std::optional<Eigen::Matrix3d> SparseGaussNewton::covariance(std::size_t k) const {
  return graph_->marginal(k);
}

std::optional<Eigen::MatrixXd> SparseGaussNewton::joint_covariance(
    std::span<const std::size_t> keyframes) const {
  return graph_->joint_covariance(keyframes);
}

std::optional<std::vector<UncertainPose>> SparseGaussNewton::motions_to_newest() const {
  return graph_->motions_to_newest();
}

EstimatorEntry sparse_gauss_newton_entry() {
  return make_relative_entry<SparseGaussNewtonOptions>(
      "sparse_gauss_newton",
      "pose-graph least squares, own sparse block solver; finds its start; incremental or batch",
      true, [](const EstimatorSetup& setup, const SparseGaussNewtonOptions& options) {
        return std::make_unique<SparseGaussNewton>(setup, options);
      });
}

}  // namespace fathom
