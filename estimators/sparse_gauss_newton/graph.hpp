#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "estimators/sparse_gauss_newton/robust.hpp"
#include "estimators/support/pose_graph/minimum_search.hpp"
#include "estimators/support/pose_graph/picture_states.hpp"
#include "fathom/estimation/precision.hpp"
#include "fathom/estimation/registry.hpp"
#include "fathom/estimation/relative_estimator.hpp"
#include "fathom/estimation/shared_error_model.hpp"
#include "fathom/geometry/covariance.hpp"

namespace fathom::sparse_gauss_newton {

using pose_graph::ExtendedGraph;

/// The poses and measurements of a log, and what is asked of them.
class Graph {
 public:
  /// `threads`: who solves it; no thread is started before the first solve. `is_gated`: innovations
  /// will be asked for.
  Graph(const EstimatorSetup& setup, const RobustOptions& robust, SharedErrorModel shared_errors,
        bool is_gated, int threads);

  std::size_t size() const { return nodes_.size(); }
  Pose pose(std::size_t k) const;
  void set_poses(std::span<const Pose> poses);

  /// A keyframe at the newest one ⊕ the step.
  void add_keyframe(const RelativePose& step);
  void add_registration(const RelativePose& registration);

  /// As of RelativeEstimator.
  void bridge(const Bridge& bridge);

  std::size_t edge_count() const { return edges_.size(); }
  /// Takes the last edges back, down to `count` of them.
  void forget_edges(std::size_t count);

  /// Leaves the poses as they were if it fails. With a loss from the estimate as it is: a whole
  /// graph that is new, or one that loops were added to.
  SolveResult solve(Start start, const SolveLimits& limits);
  SolveResult solve_robust(const SolveLimits& limits, bool from_scratch);

  /// What each registration weighs since the last solve, in the order they were added.
  std::vector<double> registration_weights() const;

  /// Of loss `truncated`, as the last solve adapted them; nothing before one, and of other losses.
  const std::optional<SquaredScales>& squared_scales() const { return squared_scales_; }

  /// The marginal covariance of a keyframe from the Gauss-Newton matrix at the estimate, a
  /// loss applied as a weight; of all at once, at the first call after a change.
  std::optional<Eigen::Matrix3d> marginal(std::size_t k);

  /// As of Estimator, from that same matrix.
  std::optional<Eigen::MatrixXd> joint_covariance(std::span<const std::size_t> keyframes) const;

  /// As of TrajectoryView.
  std::optional<std::vector<UncertainPose>> motions_to_newest() const;

  /// As of PredictedCovariances, for loops that end at the newest keyframe.
  std::optional<std::vector<Eigen::Matrix3d>> predicted_covariances(
      std::span<const RelativePose> forward_loops) const;

  /// Each as its innovation is to be tested (PictureStates::without_errors).
  std::vector<RelativePose> without_errors(std::span<const RelativePose> registrations) const;

 private:
  void changed() { marginals_.reset(); }
  Workers* workers();
  void add_edge(const RelativePose& measurement, char is_loop, int rank);
  /// Empty where all are 3.
  std::span<const char> ranks() const;

  bool has_states() const { return !states_.is_empty(); }
  ExtendedGraph weighted(const std::vector<double>& weights) const;
  RobustResult robust_result(ExtendedGraph& graph, const SolveLimits& limits,
                             std::span<const double> known);
  SolveResult accept(const SolveResult& result, const ExtendedGraph& solved);
  SolveResult searched(const SolveResult& result, Start start, ExtendedGraph& solved,
                       const SolveLimits& limits);

  RobustOptions robust_;
  SharedErrorModel shared_errors_;
  pose_graph::PictureStates states_;
  bool is_batch_;
  int threads_;
  std::unique_ptr<Workers> workers_;
  std::vector<Node> nodes_;
  std::vector<Edge> edges_;
  pose_graph::WideRows wide_rows_;  ///< of the edges
  std::vector<char> is_loop_;       ///< by edge
  std::vector<char> ranks_;         ///< by edge, of its information
  std::vector<double> weights_;     ///< by edge
  std::optional<SquaredScales> squared_scales_;
  InformationSpread spread_;
  pose_graph::MinimumSearch search_;
  double cost_ = 0.0;       ///< F after the last update
  std::size_t solved_ = 0;  ///< edges then
  std::size_t judged_ = 0;  ///< edges of the last robust solve that was done
  /// Of all keyframes; absent: to be computed, empty: could not be.
  std::optional<std::vector<Eigen::Matrix3d>> marginals_;
};

}  // namespace fathom::sparse_gauss_newton
