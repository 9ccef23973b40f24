// A plug-in with the pose-graph solver of MRPT: sparse pose adjustment, Levenberg-Marquardt.

#include <memory>
#include <mrpt/graphs/CNetworkOfPoses.h>
#include <mrpt/graphslam/levmarq.h>
#include <vector>

#include "adapters/support/graph_adapter.hpp"
#include "fathom/estimation/plugin.hpp"

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

  void check(const EstimatorSetup& setup) const { check_gate(gate, setup, false); }
};

using Graph = mrpt::graphs::CNetworkOfPoses2DInf;

mrpt::poses::CPose2D to_mrpt(const Pose& pose) {
  return {pose.x, pose.y, pose.theta};
}

/// MRPT has no covariance of the poses.
class Mrpt final : public GraphAdapter {
 public:
  Mrpt(const EstimatorSetup& setup, const Options& options)
      : GraphAdapter(setup, options.gate), options_(options) {}

  std::optional<Eigen::MatrixXd> joint_covariance(std::span<const std::size_t>) const override {
    return std::nullopt;
  }

 private:
  Graph graph_at(const std::vector<Pose>& poses) const {
    Graph graph;
    graph.root = 0;
    for (std::size_t k = 0; k < poses.size(); ++k) graph.nodes[k] = to_mrpt(poses[k]);
    for (const RelativePose& z : edges()) {
      graph.insertEdge(z.from, z.to,
                       mrpt::poses::CPosePDFGaussianInf(
                           to_mrpt(z.motion), mrpt::math::CMatrixDouble33(z.information)));
    }
    return graph;
  }

  UpdateReport solve(std::vector<Pose>& poses) override {
    Graph graph = graph_at(poses);
    mrpt::containers::yaml settings = mrpt::containers::yaml::Map();
    settings["max_iterations"] = options_.max_iterations;
    settings["initial_lambda"] = options_.initial_lambda;
    settings["e1"] = options_.gradient_tolerance;
    settings["e2"] = options_.tolerance;
    mrpt::graphslam::TResultInfoSpaLevMarq result;
    mrpt::graphslam::optimize_graph_spa_levmarq(graph, result, nullptr, settings);
    for (std::size_t k = 0; k < poses.size(); ++k) {
      const mrpt::poses::CPose2D& pose = graph.nodes.at(k);
      poses[k] = {pose.x(), pose.y(), wrap_angle(pose.phi())};
    }
    UpdateReport report;
    report.iterations = static_cast<int>(result.num_iters);
    if (report.iterations >= options_.max_iterations) report.outcome = Outcome::iteration_limit;
    return report;
  }

  Options options_;
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
