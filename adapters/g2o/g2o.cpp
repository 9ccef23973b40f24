// A plug-in with the pose-graph solvers of g2o: Gauss-Newton, Levenberg-Marquardt, dogleg, and
// Gauss-Newton from g2o's own linear start, with CHOLMOD.

#include <g2o/core/sparse_optimizer.h>
#include <g2o/core/sparse_optimizer_terminate_action.h>
#include <g2o/types/slam2d/edge_se2.h>
#include <g2o/types/slam2d/vertex_se2.h>
#include <memory>
#include <utility>
#include <vector>

#include "adapters/g2o/algorithm.hpp"
#include "adapters/support/graph_adapter.hpp"
#include "fathom/estimation/plugin.hpp"

namespace {

using namespace fathom;
using namespace fathom::g2o_adapter;

g2o::SE2 to_g2o(const Pose& pose) {
  return {pose.x, pose.y, pose.theta};
}

class G2o final : public GraphAdapter {
 public:
  G2o(const EstimatorSetup& setup, const Options& options)
      : GraphAdapter(setup, options.gate), options_(options) {
    const bool is_batch = setup.mode == SolveMode::batch;
    use(options.method == Method::slam2d_linear && !is_batch ? Method::gauss_newton
                                                             : options.method);
    optimizer_.setForceStopFlag(&is_stopped_);
  }

  /// Of every keyframe alone at once, and kept: whoever asks for one asks for all.
  std::optional<Eigen::Matrix3d> covariance(std::size_t k) const override {
    if (k == 0) return Eigen::Matrix3d::Zero();
    if (!has_marginals() || !linearise()) return std::nullopt;
    if (!diagonal_) {
      std::vector<std::pair<int, int>> blocks;
      for (std::size_t i = 1; i < size(); ++i) blocks.emplace_back(row_of(i), row_of(i));
      diagonal_.emplace();
      has_diagonal_ = optimizer_.computeMarginals(*diagonal_, blocks);
    }
    if (!has_diagonal_) return std::nullopt;
    return Eigen::Matrix3d(*diagonal_->block(row_of(k), row_of(k)));
  }

  std::optional<Eigen::MatrixXd> joint_covariance(
      std::span<const std::size_t> keyframes) const override {
    const std::vector<std::size_t> free = free_keyframes(keyframes);
    if (free.empty()) return in_order_of(keyframes, {});
    if (!has_marginals() || !linearise()) return std::nullopt;
    std::vector<std::pair<int, int>> blocks;
    for (const std::size_t i : free) {
      for (const std::size_t k : free) {
        if (row_of(i) <= row_of(k)) blocks.emplace_back(row_of(i), row_of(k));
      }
    }
    g2o::SparseBlockMatrix<g2o::MatrixX> inverse;
    if (!optimizer_.computeMarginals(inverse, blocks)) return std::nullopt;
    const auto m = static_cast<Eigen::Index>(3 * free.size());
    Eigen::MatrixXd joint(m, m);
    for (Eigen::Index i = 0; i < m; i += 3) {
      for (Eigen::Index k = i; k < m; k += 3) {
        const int row = row_of(free[static_cast<std::size_t>(i / 3)]);
        const int column = row_of(free[static_cast<std::size_t>(k / 3)]);
        joint.block<3, 3>(i, k) = row <= column
                                      ? Eigen::Matrix3d(*inverse.block(row, column))
                                      : Eigen::Matrix3d(inverse.block(column, row)->transpose());
      }
    }
    return in_order_of(keyframes, joint);
  }

 private:
  void use(Method method) {
    algorithm_ = make_algorithm(method).release();
    algorithm_->setWriteDebug(false);     // a file in the working directory
    optimizer_.setAlgorithm(algorithm_);  // owns it, and frees the one before
  }

  // g2o numbers the elements of the inverse by an int: with more rows they are others.
  bool has_marginals() const {
    constexpr std::size_t kMostRows = 46340;
    return 3 * (size() - 1) <= kMostRows;
  }

  // Active are the vertices of edges alone.
  bool is_ready() const {
    return optimizer_.initializeOptimization() && optimizer_.indexMapping().size() + 1 == size();
  }

  g2o::VertexSE2* vertex(std::size_t k) const {
    return static_cast<g2o::VertexSE2*>(optimizer_.vertex(static_cast<int>(k)));
  }
  int row_of(std::size_t k) const { return vertex(k)->hessianIndex(); }

  // What has come since the last solve is added; the graph stays.
  void extend() const {
    for (std::size_t k = optimizer_.vertices().size(); k < size(); ++k) {
      auto* added = new g2o::VertexSE2;  // the graph owns what it is given
      added->setId(static_cast<int>(k));
      added->setFixed(k == 0);
      optimizer_.addVertex(added);
    }
    for (; edge_count_ < edges().size(); ++edge_count_) {
      const RelativePose& z = edges()[edge_count_];
      auto* added = new g2o::EdgeSE2;
      added->setVertex(0, vertex(z.from));
      added->setVertex(1, vertex(z.to));
      added->setMeasurement(to_g2o(z.motion));
      added->setInformation(z.information);
      optimizer_.addEdge(added);
    }
  }

  void edges_replaced() override {
    optimizer_.clear();
    edge_count_ = 0;
    is_linearised_ = false;
  }

  void place(const std::vector<Pose>& poses) const {
    for (std::size_t k = 0; k < poses.size(); ++k) vertex(k)->setEstimate(to_g2o(poses[k]));
  }

  UpdateReport solve(std::vector<Pose>& poses) override {
    is_linearised_ = false;
    // Headings would be taken from edges that measure none.
    const auto is_whole = [](const RelativePose& z) { return is_positive_definite(z.information); };
    if (options_.method == Method::slam2d_linear && !std::ranges::all_of(edges(), is_whole)) {
      use(Method::gauss_newton);
    }
    extend();
    place(poses);
    UpdateReport report;
    if (!is_ready()) {
      report.outcome = Outcome::numerical_failure;
      return report;
    }
    g2o::SparseOptimizerTerminateAction small_gain;
    small_gain.setGainThreshold(options_.tolerance);
    is_stopped_ = false;
    optimizer_.addPostIterationAction(&small_gain);
    report.iterations = optimizer_.optimize(options_.max_iterations);
    optimizer_.removePostIterationAction(&small_gain);
    if (report.iterations <= 0) {
      report.iterations = 0;
      report.outcome = Outcome::numerical_failure;
      return report;
    }
    // Where F is rounding alone, the gain is a share of nothing and ends no solve.
    constexpr double kRounding = 1e-9;
    if (report.iterations >= options_.max_iterations && optimizer_.activeChi2() > kRounding) {
      report.outcome = Outcome::iteration_limit;
    }
    for (std::size_t k = 0; k < poses.size(); ++k) {
      const g2o::SE2& pose = vertex(k)->estimate();
      poses[k] = {pose.translation().x(), pose.translation().y(),
                  wrap_angle(pose.rotation().angle())};
    }
    return report;
  }

  // The Hessian that a solve leaves is that of before its last step, and steps may have come since.
  bool linearise() const {
    if (is_linearised_ && linearised_size_ == size() && edge_count_ == edges().size()) return true;
    extend();
    place(poses());
    if (!is_ready() || !algorithm_->init() || !algorithm_->buildLinearStructure()) {
      return false;
    }
    optimizer_.computeActiveErrors();
    algorithm_->updateLinearSystem();
    diagonal_.reset();
    is_linearised_ = true;
    linearised_size_ = size();
    return true;
  }

  Options options_;
  Algorithm* algorithm_ = nullptr;
  // What g2o keeps is the same graph as edges() and poses(); questions may bring it up to date.
  mutable g2o::SparseOptimizer optimizer_;
  mutable std::size_t edge_count_ = 0;
  mutable bool is_linearised_ = false;
  mutable std::size_t linearised_size_ = 0;
  mutable std::optional<g2o::SparseBlockMatrix<g2o::MatrixX>> diagonal_;
  mutable bool has_diagonal_ = false;
  bool is_stopped_ = false;
};

void add_estimators(EstimatorRegistry& registry) {
  EstimatorEntry entry = make_relative_entry<Options>(
      "g2o", "g2o with CHOLMOD on the pose graph, solved anew at each update", true,
      [](const EstimatorSetup& setup, const Options& options) {
        return std::make_unique<G2o>(setup, options);
      });
  registry.add(std::move(entry));
}

}  // namespace

FATHOM_PLUGIN(add_estimators)
