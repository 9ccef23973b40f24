#include "estimators/ceres_pose_graph/ceres_pose_graph.hpp"

#include <cmath>
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
  table.enumeration("loss", loss,
                    {{"none", Loss::none}, {"huber", Loss::huber}, {"cauchy", Loss::cauchy}},
                    "robust loss on registrations; dead reckoning has none");
  table.real("loss_scale", loss_scale, Range::positive(), "sigma",
             "whitened residual at which the loss sets in");
  gate.describe(table);
}

void CeresPoseGraphOptions::check(const EstimatorSetup& setup) const {
  if (setup.mode == SolveMode::batch && gate.probability) {
    throw InputError(
        "gate_probability: a batch solve has no innovation to gate; use the incremental mode, or a "
        "loss");
  }
}

CeresPoseGraph::CeresPoseGraph(const EstimatorSetup& setup, const CeresPoseGraphOptions& options)
    : options_(options),
      mode_(setup.mode),
      gate_(options.gate),
      graph_(std::make_unique<Graph>(setup.origin, options)) {}

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
  UpdateReport report;
  if (registrations.empty()) return report;
  if (!judge(registrations, report)) {
    lose_all(report, Outcome::numerical_failure);
    return report;
  }
  const std::size_t before = graph_->registration_count();
  for (std::size_t j = 0; j < registrations.size(); ++j) {
    if (report.loops[j].fate == LoopFate::used) graph_->add_registration(registrations[j]);
  }
  if (graph_->registration_count() == before || mode_ == SolveMode::batch) return report;
  const UpdateReport solved = graph_->solve();
  report.outcome = solved.outcome;
  report.iterations = solved.iterations;
  if (is_done(report.outcome)) return report;
  graph_->forget_registrations(before);
  lose_all(report, solved.outcome);
  return report;
}

bool CeresPoseGraph::judge(std::span<const RelativePose> registrations, UpdateReport& report) {
  const auto covariances = [&](std::span<const RelativePose> forward) {
    return graph_->innovation_covariances(forward);
  };
  return fathom::judge(gate_, *this, registrations, covariances, report);
}

UpdateReport CeresPoseGraph::finish(std::span<const Pose> start) {
  if (mode_ != SolveMode::batch || graph_->size() < 2) return {};
  if (!start.empty()) graph_->set_poses(start);
  return graph_->solve();
}

std::optional<Eigen::Matrix3d> CeresPoseGraph::covariance(std::size_t k) {
  return graph_->marginal(k);
}

std::optional<std::vector<UncertainPose>> CeresPoseGraph::motions_to_newest() const {
  return graph_->motions_to_newest();
}

// Huber: s up to a², then 2 a √s − a². Cauchy: a² ln(1 + s / a²). With the whitened residual's
// squared norm s and the scale a; as Ceres defines them.
double CeresPoseGraph::loss(double chi2) const {
  const double a = options_.loss_scale;
  switch (options_.loss) {
    case CeresPoseGraphOptions::Loss::huber:
      return chi2 <= a * a ? chi2 : 2.0 * a * std::sqrt(chi2) - a * a;
    case CeresPoseGraphOptions::Loss::cauchy:
      return a * a * std::log1p(chi2 / (a * a));
    case CeresPoseGraphOptions::Loss::none:
      break;
  }
  return chi2;
}

EstimatorEntry ceres_pose_graph_entry() {
  return make_entry<CeresPoseGraphOptions>(
      "ceres_pose_graph", "pose-graph least squares with Ceres, incremental or batch", true,
      [](const EstimatorSetup& setup, const CeresPoseGraphOptions& options) {
        return std::make_unique<CeresPoseGraph>(setup, options);
      });
}

}  // namespace fathom
