#include <cmath>
#include <gtsam/nonlinear/DoglegOptimizer.h>
#include <gtsam/nonlinear/GaussNewtonOptimizer.h>
#include <gtsam/nonlinear/LevenbergMarquardtOptimizer.h>
#include <memory>
#include <utility>

#include "adapters/gtsam/entries.hpp"
#include "adapters/gtsam/factors.hpp"
#include "adapters/support/graph_adapter.hpp"

namespace fathom {
namespace {

enum class Method { levenberg_marquardt, gauss_newton, dogleg };
enum class Start { given, lago };

// The numbers are GTSAM's own defaults.
struct GtsamOptions {
  Method method = Method::levenberg_marquardt;
  Start start = Start::given;
  int max_iterations = 100;
  double tolerance = 1e-5;
  bool exact_jacobians = false;
  bool nested_dissection = false;
  GateOptions gate;

  void describe(OptionTable& table) {
    table.enumeration("method", method,
                      {{"levenberg_marquardt", Method::levenberg_marquardt},
                       {"gauss_newton", Method::gauss_newton},
                       {"dogleg", Method::dogleg}},
                      "GTSAM's optimizer");
    table.enumeration("start", start, {{"given", Start::given}, {"lago", Start::lago}},
                      "where a batch solve starts: where it is told to, or GTSAM's LAGO");
    table.integer("max_iterations", max_iterations, Range::at_least(1), "",
                  "iterations of one solve at most");
    table.real("tolerance", tolerance, Range::at_least(0.0), "",
               "GTSAM's relativeErrorTol and absoluteErrorTol: it stops where half of F falls by a "
               "smaller share, or by less");
    table.boolean("exact_jacobians", exact_jacobians,
                  "factors of the adapter, with Jacobians that GTSAM leaves a part out of");
    table.boolean("nested_dissection", nested_dissection,
                  "variables are ordered by METIS, not by COLAMD");
    gate.describe(table);
  }

  void check(const EstimatorSetup& setup) const { check_gate(gate, setup, true); }
};

class GtsamGraph final : public GraphAdapter {
 public:
  GtsamGraph(const EstimatorSetup& setup, const GtsamOptions& options)
      : GraphAdapter(setup, options.gate),
        options_(options),
        is_batch_(setup.mode == SolveMode::batch) {}

  std::optional<Eigen::MatrixXd> joint_covariance(
      std::span<const std::size_t> nodes) const override {
    const Linearised* linearised = linearise();
    if (linearised == nullptr) return std::nullopt;
    return joint_of(linearised->marginals, linearised->poses, nodes);
  }

 private:
  struct Linearised {
    gtsam::Values poses;
    gtsam::Marginals marginals;
  };

  void edges_replaced() override {
    graph_ = {};
    edge_count_ = 0;
    linearised_.reset();
  }

  void extend() const {
    if (graph_.empty()) add_prior(graph_, poses()[0]);
    for (; edge_count_ < edges().size(); ++edge_count_) {
      add_edge(graph_, edges()[edge_count_], options_.exact_jacobians);
    }
  }

  static gtsam::Values values_of(const std::vector<Pose>& poses) {
    gtsam::Values values;
    for (std::size_t k = 0; k < poses.size(); ++k) values.insert(k, to_gtsam(poses[k]));
    return values;
  }

  template <class Parameters>
  Parameters parameters() const {
    Parameters parameters;
    parameters.maxIterations = static_cast<std::size_t>(options_.max_iterations);
    parameters.relativeErrorTol = options_.tolerance;
    parameters.absoluteErrorTol = options_.tolerance;
    if (options_.nested_dissection) parameters.orderingType = gtsam::Ordering::METIS;
    return parameters;
  }

  std::unique_ptr<gtsam::NonlinearOptimizer> optimizer(const gtsam::Values& start) const {
    using namespace gtsam;
    switch (options_.method) {
      case Method::levenberg_marquardt:
        break;
      case Method::gauss_newton:
        return std::make_unique<GaussNewtonOptimizer>(graph_, start,
                                                      parameters<GaussNewtonParams>());
      case Method::dogleg:
        return std::make_unique<DoglegOptimizer>(graph_, start, parameters<DoglegParams>());
    }
    return std::make_unique<LevenbergMarquardtOptimizer>(graph_, start,
                                                         parameters<LevenbergMarquardtParams>());
  }

  // Levenberg-Marquardt returns where it finds no step that lowers F, with its damping at the upper
  // bound: where there is nothing to lower, it has converged.
  bool has_given_up(const gtsam::NonlinearOptimizer& solver) const {
    const auto* damped = dynamic_cast<const gtsam::LevenbergMarquardtOptimizer*>(&solver);
    return damped != nullptr && damped->lambda() >= damped->params().lambdaUpperBound &&
           solver.error() > options_.tolerance;
  }

  // The loop of NonlinearOptimizer::optimize, which takes an iteration that raised F for the last
  // of a convergence.
  Outcome minimise(gtsam::NonlinearOptimizer& solver) const {
    const auto limit = static_cast<std::size_t>(options_.max_iterations);
    double before = 0.0;
    double error = solver.error();
    do {
      before = error;
      solver.iterate();
      error = solver.error();
    } while (solver.iterations() < limit && std::isfinite(error) &&
             !gtsam::checkConvergence(options_.tolerance, options_.tolerance, 0.0, before, error));
    if (!(error <= before + options_.tolerance * (1.0 + before))) return Outcome::diverged;
    const bool has_time = solver.iterations() < limit;
    return has_time && !has_given_up(solver) ? Outcome::converged : Outcome::iteration_limit;
  }

  // LAGO needs an edge of full rank from each node to the next.
  gtsam::Values start_of(const std::vector<Pose>& poses) const {
    if (options_.start == Start::given || !is_batch_) return values_of(poses);
    try {
      return lago_start(edges(), poses[0]);
    } catch (const std::exception&) {
      return values_of(poses);
    }
  }

  UpdateReport solve(std::vector<Pose>& poses) override {
    linearised_.reset();
    UpdateReport report;
    try {
      extend();
      const auto solver = optimizer(start_of(poses));
      report.outcome = minimise(*solver);
      report.iterations = static_cast<int>(solver->iterations());
      for (std::size_t k = 0; k < poses.size(); ++k) {
        poses[k] = from_gtsam(solver->values().at<gtsam::Pose2>(k));
      }
    } catch (const std::exception&) {
      report.outcome = Outcome::numerical_failure;
    }
    return report;
  }

  const Linearised* linearise() const {
    const bool is_fresh = linearised_ && edge_count_ == edges().size();
    if (is_fresh && linearised_->poses.size() == size()) return &*linearised_;
    try {
      extend();
      const gtsam::Values values = values_of(poses());
      linearised_ = Linearised{values, gtsam::Marginals(graph_, values)};
      return &*linearised_;
    } catch (const std::exception&) {
      linearised_.reset();
      return nullptr;
    }
  }

  GtsamOptions options_;
  bool is_batch_;
  // The same graph as edges(); questions may bring it up to date.
  mutable gtsam::NonlinearFactorGraph graph_;
  mutable std::size_t edge_count_ = 0;
  mutable std::optional<Linearised> linearised_;
};

}  // namespace

EstimatorEntry gtsam_entry() {
  return make_relative_entry<GtsamOptions>(
      "gtsam", "GTSAM on the pose graph, solved anew at each update", true,
      [](const EstimatorSetup& setup, const GtsamOptions& options) {
        return std::make_unique<GtsamGraph>(setup, options);
      });
}

}  // namespace fathom
