#include "estimators/incremental_smoother/incremental_smoother.hpp"

#include <vector>

#include "estimators/incremental_smoother/smoother.hpp"
#include "estimators/support/pose_graph/information.hpp"
#include "fathom/core/input_error.hpp"

namespace fathom {

using incremental_smoother::ErrorStates;
using incremental_smoother::Smoother;
using incremental_smoother::SmootherLimits;
using incremental_smoother::SmootherResult;

namespace {

// A loss is on what is left without the errors: then a picture with one registration has its own.
ErrorStates error_states_of(const IncrementalSmootherOptions& options) {
  if (options.shared.model != SharedErrorModel::states) return ErrorStates::none;
  return options.loss.kind != LossKind::none ? ErrorStates::all : ErrorStates::of_several;
}

}  // namespace

void IncrementalSmootherOptions::describe(OptionTable& table) {
  table.integer("max_iterations", max_iterations, Range::at_least(1), "",
                "steps of one update at most");
  table.real("tolerance", tolerance, Range::positive(), "",
             "an update has converged when the cost exceeds its minimum by a smaller share");
  table.real("relinearise_m", relinearise_m, Range::positive(), "m",
             "keyframes are linearised again when they moved by more to each other");
  table.real("relinearise_rad", relinearise_rad, Range::positive(), "rad",
             "likewise, when they turned by more, or moved by more of their distance");
  loss.describe(table);
  shared.describe(table);
  gate.describe(table);
}

void IncrementalSmootherOptions::check(const EstimatorSetup&) const {
  loss.check();
}

IncrementalSmoother::IncrementalSmoother(const EstimatorSetup& setup,
                                         const IncrementalSmootherOptions& options)
    : loss_(options.loss),
      shared_errors_(options.shared.model),
      gate_(options.gate),
      smoother_(
          std::make_unique<Smoother>(setup.start.pose,
                                     SmootherLimits{options.max_iterations, options.tolerance,
                                                    options.relinearise_m, options.relinearise_rad},
                                     loss_, error_states_of(options))) {}

IncrementalSmoother::~IncrementalSmoother() = default;

std::size_t IncrementalSmoother::size() const {
  return smoother_->size();
}

Pose IncrementalSmoother::pose(std::size_t k) const {
  return smoother_->pose(k);
}

MovedPoses IncrementalSmoother::moved_since(std::uint64_t revision) const {
  return smoother_->moved_since(revision);
}

void IncrementalSmoother::add_keyframe(const RelativePose& step) {
  marginals_.reset();
  smoother_->add_keyframe(step);
}

UpdateReport IncrementalSmoother::close_loops(std::span<const RelativePose> registrations) {
  UpdateReport report = judged_update(
      gate_, *this, registrations,
      [this](auto forward) { return smoother_->predicted_covariances(forward); },
      [this](auto used) {
        marginals_.reset();
        const SmootherResult result = smoother_->add_registrations(used);
        return UpdateReport{result.outcome, result.iterations, {}};
      },
      gate_.is_on() ? smoother_->without_errors(registrations) : std::vector<RelativePose>());
  if (loss_.is_on()) used_loops_.note(report);
  return report;
}

// Without a loss the fates of the loops say what they weigh.
std::vector<double> IncrementalSmoother::loop_weights() const {
  if (!loss_.is_on()) return {};
  return used_loops_.weights(smoother_->loop_weights());
}

std::optional<LoopDecision> IncrementalSmoother::bridge(const Bridge& bridge) {
  marginals_.reset();
  smoother_->bridge(bridge);
  return std::nullopt;
}

std::optional<Eigen::Matrix3d> IncrementalSmoother::covariance(std::size_t k) const {
  if (!marginals_) {
    const pose_graph::ExtendedGraph graph = smoother_->weighted_graph();
    marginals_ =
        pose_graph::marginals(graph.edges, graph.nodes).value_or(std::vector<Eigen::Matrix3d>{});
  }
  if (marginals_->empty()) return std::nullopt;
  return (*marginals_)[k];
}

std::optional<Eigen::MatrixXd> IncrementalSmoother::joint_covariance(
    std::span<const std::size_t> keyframes) const {
  const pose_graph::ExtendedGraph graph = smoother_->weighted_graph();
  return pose_graph::joint_covariance(graph.edges, graph.nodes, keyframes);
}

std::optional<Eigen::Matrix3d> IncrementalSmoother::newest_covariance() const {
  if (const auto covariance = smoother_->newest_covariance()) return covariance;
  return RelativeEstimator::newest_covariance();
}

std::optional<std::vector<UncertainPose>> IncrementalSmoother::motions_to_newest() const {
  const pose_graph::ExtendedGraph graph = smoother_->weighted_graph();
  return pose_graph::motions_to_newest(graph.edges, graph.nodes);
}

EstimatorEntry incremental_smoother_entry() {
  return make_relative_entry<IncrementalSmootherOptions>(
      "incremental_smoother",
      "pose-graph least squares, an estimate per keyframe: eliminates again only what loops touch",
      false, [](const EstimatorSetup& setup, const IncrementalSmootherOptions& options) {
        return std::make_unique<IncrementalSmoother>(setup, options);
      });
}

}  // namespace fathom
