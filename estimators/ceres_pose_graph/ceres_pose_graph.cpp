#include "estimators/ceres_pose_graph/ceres_pose_graph.hpp"

#include <algorithm>
#include <vector>

#include "estimators/ceres_pose_graph/graph.hpp"

namespace fathom {

void CeresPoseGraphOptions::describe(OptionTable& table) {
  table.integer("max_iterations", max_iterations, Range::at_least(1), "",
                "Levenberg-Marquardt iterations of one solve at most");
  table.real("tolerance", tolerance, Range::positive(), "",
             "a solve has converged when cost or poses change by a smaller share");
  table.real("initial_trust_region", initial_trust_region, Range::positive(), "",
             "initial radius; very large is Gauss-Newton until a step fails");
  loss.describe(table);
  shared.describe(table);
  gate.describe(table);
}

void CeresPoseGraphOptions::check(const EstimatorSetup& setup) const {
  loss.check();
  if (setup.mode == SolveMode::batch && gate.probability) {
    throw InputError(
        "gate_probability: a batch solve has no innovation to gate; use the incremental mode, or a "
        "loss");
  }
}

CeresPoseGraph::CeresPoseGraph(const EstimatorSetup& setup, const CeresPoseGraphOptions& options)
    : options_(options),
      mode_(setup.mode),
      loss_(options.loss),
      gate_(options.gate),
      graph_(std::make_unique<Graph>(setup.start.pose, setup.mode, options)) {}

CeresPoseGraph::~CeresPoseGraph() = default;

std::size_t CeresPoseGraph::size() const {
  return graph_->size();
}

Pose CeresPoseGraph::pose(std::size_t k) const {
  return graph_->pose(k);
}

void CeresPoseGraph::add_keyframe(const RelativePose& step) {
  graph_->add_keyframe(step);
}

UpdateReport CeresPoseGraph::close_loops(std::span<const RelativePose> registrations) {
  UpdateReport report = judged_update(
      gate_, *this, registrations,
      [this](auto forward) { return graph_->predicted_covariances(forward); },
      [this](auto used) { return minimise_with(used); },
      gate_.is_on() ? graph_->without_errors(registrations) : std::vector<RelativePose>());
  used_loops_.note(report);
  return report;
}

UpdateReport CeresPoseGraph::minimise_with(std::span<const RelativePose> registrations) {
  const std::size_t before = graph_->registration_count();
  for (const RelativePose& z : registrations) graph_->add_registration(z);
  if (mode_ == SolveMode::batch) return {};
  UpdateReport solved = graph_->solve();
  if (!is_done(solved.outcome)) graph_->forget_registrations(before);
  return solved;
}

UpdateReport CeresPoseGraph::finish(std::span<const Pose> start) {
  if (mode_ != SolveMode::batch || graph_->size() < 2) return {};
  if (!start.empty()) graph_->set_poses(start);
  return loss_.is_on() ? graph_->solve_robust() : graph_->solve();
}

std::optional<LoopDecision> CeresPoseGraph::bridge(const Bridge& bridge) {
  graph_->bridge(bridge);
  return std::nullopt;
}

std::optional<Eigen::Matrix3d> CeresPoseGraph::covariance(std::size_t k) const {
  return graph_->marginal(k);
}

std::optional<Eigen::MatrixXd> CeresPoseGraph::joint_covariance(
    std::span<const std::size_t> keyframes) const {
  return graph_->joint_covariance(keyframes);
}

std::optional<std::vector<UncertainPose>> CeresPoseGraph::motions_to_newest() const {
  return graph_->motions_to_newest();
}

std::vector<double> CeresPoseGraph::loop_weights() const {
  std::vector<double> of_used(graph_->registration_count());
  for (std::size_t j = 0; j < of_used.size(); ++j) {
    of_used[j] = graph_->registration_weight(j);
  }
  return used_loops_.weights(of_used);
}

EstimatorEntry ceres_pose_graph_entry() {
  return make_relative_entry<CeresPoseGraphOptions>(
      "ceres_pose_graph", "pose-graph least squares with Ceres, incremental or batch", true,
      [](const EstimatorSetup& setup, const CeresPoseGraphOptions& options) {
        return std::make_unique<CeresPoseGraph>(setup, options);
      });
}

}  // namespace fathom
