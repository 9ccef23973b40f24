// A plug-in with the pose-graph solver of MRPT: sparse pose adjustment, Levenberg-Marquardt.

#include <cmath>
#include <memory>
#include <mrpt/graphs/CNetworkOfPoses.h>
#include <mrpt/graphslam/levmarq.h>
#include <vector>

#include "fathom/core/input_error.hpp"
#include "fathom/estimation/gate.hpp"
#include "fathom/estimation/plugin.hpp"
#include "fathom/estimation/relative_estimator.hpp"

namespace {

using namespace fathom;

// Its own defaults, of which the documentation of optimize_graph_spa_levmarq has other values than
// the code: tau is 1e-3.
struct Options {
  int max_iterations = 100;
  double tolerance = 1e-6;
  double gradient_tolerance = 1e-6;
  double initial_lambda = 0.0;
  GateOptions gate;

  void describe(OptionTable& table) {
    table.integer("max_iterations", max_iterations, Range::at_least(1), "",
                  "Levenberg-Marquardt iterations of one solve at most");
    table.real("tolerance", tolerance, Range::positive(), "",
               "MRPT's e2: it stops where a step is below so much of the state");
    table.real("gradient_tolerance", gradient_tolerance, Range::positive(), "",
               "MRPT's e1: it stops where no element of the gradient is larger");
    table.real("initial_lambda", initial_lambda, Range::at_least(0.0), "",
               "damping at the start; 0: MRPT chooses it");
    gate.describe(table);
  }

  void check(const EstimatorSetup&) const {
    if (gate.probability) {
      throw InputError("gate_probability: there is no covariance to gate with; use off");
    }
  }
};

using Graph = mrpt::graphs::CNetworkOfPoses2DInf;

mrpt::poses::CPose2D to_mrpt(const Pose& pose) {
  return {pose.x, pose.y, pose.theta};
}

/// Solved anew, from the estimate so far, whenever loops arrive, or once at the end in batch mode.
/// MRPT has no covariance of the poses.
class Mrpt final : public RelativeEstimator {
 public:
  Mrpt(const EstimatorSetup& setup, const Options& options)
      : options_(options), mode_(setup.mode), poses_{setup.start.pose} {}

  void add_keyframe(const RelativePose& step) override {
    poses_.push_back(compose(poses_.back(), step.forward().motion));
    if (mode_ == SolveMode::incremental || !step.is_hole) edges_.push_back(step);
  }

  UpdateReport close_loops(std::span<const RelativePose> loops) override {
    edges_.insert(edges_.end(), loops.begin(), loops.end());
    UpdateReport report;
    if (mode_ == SolveMode::incremental) report = solve();
    const bool is_used = is_done(report.outcome);
    if (!is_used) edges_.resize(edges_.size() - loops.size());
    for (const RelativePose& z : loops) {
      report.loops.push_back(
          {z.from, z.to, is_used ? LoopFate::used : LoopFate::lost, std::nullopt});
    }
    return report;
  }

  UpdateReport finish(std::span<const Pose> start) override {
    if (mode_ == SolveMode::incremental) return {};
    const std::vector<Pose> before = poses_;
    if (!start.empty()) poses_.assign(start.begin(), start.end());
    const UpdateReport report = solve();
    if (!is_done(report.outcome)) poses_ = before;
    return report;
  }

  std::optional<Eigen::MatrixXd> joint_covariance(std::span<const std::size_t>) const override {
    return std::nullopt;
  }
  std::size_t size() const override { return poses_.size(); }
  Pose pose(std::size_t k) const override { return poses_[k]; }

 private:
  Graph graph() const {
    Graph graph;
    graph.root = 0;
    for (std::size_t k = 0; k < poses_.size(); ++k) graph.nodes[k] = to_mrpt(poses_[k]);
    for (const RelativePose& z : edges_) {
      graph.insertEdge(z.from, z.to,
                       mrpt::poses::CPosePDFGaussianInf(
                           to_mrpt(z.motion), mrpt::math::CMatrixDouble33(z.information)));
    }
    return graph;
  }

  UpdateReport solve() {
    UpdateReport report;
    if (edges_.empty() || poses_.size() < 2) return report;
    // With a NaN no step is an improvement to MRPT, and it has converged.
    for (const RelativePose& z : edges_) {
      if (is_finite(z.motion) && z.information.allFinite()) continue;
      report.outcome = Outcome::numerical_failure;
      return report;
    }
    Graph all = graph();
    mrpt::containers::yaml settings = mrpt::containers::yaml::Map();
    settings["max_iterations"] = options_.max_iterations;
    settings["initial_lambda"] = options_.initial_lambda;
    settings["e1"] = options_.gradient_tolerance;
    settings["e2"] = options_.tolerance;
    mrpt::graphslam::TResultInfoSpaLevMarq result;
    mrpt::graphslam::optimize_graph_spa_levmarq(all, result, nullptr, settings);
    report.iterations = static_cast<int>(result.num_iters);
    std::vector<Pose> solved{poses_[0]};
    for (std::size_t k = 1; k < poses_.size(); ++k) {
      const mrpt::poses::CPose2D& pose = all.nodes.at(k);
      solved.push_back({pose.x(), pose.y(), wrap_angle(pose.phi())});
      if (is_finite(solved.back())) continue;
      report.outcome = Outcome::numerical_failure;
      return report;
    }
    poses_ = std::move(solved);
    if (report.iterations >= options_.max_iterations) report.outcome = Outcome::iteration_limit;
    return report;
  }

  Options options_;
  SolveMode mode_;
  std::vector<Pose> poses_;
  std::vector<RelativePose> edges_;
};

void add_estimators(EstimatorRegistry& registry) {
  EstimatorEntry entry = make_relative_entry<Options>(
      "mrpt", "Levenberg-Marquardt of MRPT on the pose graph, solved anew at each update", true,
      [](const EstimatorSetup& setup, const Options& options) {
        return std::make_unique<Mrpt>(setup, options);
      });
  registry.add(std::move(entry));
}

}  // namespace

FATHOM_PLUGIN(add_estimators)
