#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "fathom/core/input_error.hpp"
#include "fathom/estimation/gate.hpp"
#include "fathom/estimation/joint_covariance.hpp"
#include "fathom/estimation/relative_estimator.hpp"
#include "fathom/geometry/covariance.hpp"

namespace fathom {

/// H P Hᵀ of each of some loops that are written forward (PredictedCovariances), from the joint
/// covariance of its two nodes.
inline std::optional<std::vector<Eigen::Matrix3d>> predicted_covariances(
    const Estimate& estimate, std::span<const RelativePose> forward) {
  std::vector<Eigen::Matrix3d> covariances;
  for (const RelativePose& z : forward) {
    const auto joint = estimate.joint_covariance(std::array{z.from, z.to});
    if (!joint) return std::nullopt;
    const PairCovariance pair{joint->topLeftCorner<3, 3>(), joint->bottomRightCorner<3, 3>(),
                              joint->topRightCorner<3, 3>()};
    covariances.push_back(between(estimate.pose(z.from), estimate.pose(z.to), pair).covariance);
  }
  return covariances;
}

/// What is behind a hole moves as one, and the hole's edge with it.
inline void move_behind_hole(const Bridge& bridge, std::vector<Pose>& poses,
                             std::vector<RelativePose>& edges) {
  for (std::size_t k = 0; k < poses.size(); ++k) {
    if (bridge.moves[k]) poses[k] = compose(bridge.motion, poses[k]);
  }
  for (RelativePose& edge : edges) {
    if (!edge.is_hole || bridge.moves[edge.from] == bridge.moves[edge.to]) continue;
    edge.motion = between(poses[edge.from], poses[edge.to]);
  }
}

/// What is alike in adapters to solvers of whole pose graphs: the graph is solved anew, from the
/// estimate so far, whenever loops arrive, or once at the end in batch mode. Node 0 is fixed.
class GraphAdapter : public RelativeEstimator {
 public:
  GraphAdapter(const EstimatorSetup& setup, const GateOptions& gate)
      : mode_(setup.mode), gate_(gate), poses_{setup.start.pose} {}

  void add_keyframe(const RelativePose& step) override {
    poses_.push_back(compose(poses_.back(), step.forward().motion));
    if (mode_ == SolveMode::incremental || !step.is_hole) edges_.push_back(step);
  }

  UpdateReport close_loops(std::span<const RelativePose> loops) override {
    return judged_update(
        gate_, *this, loops, [this](auto forward) { return predicted_covariances(*this, forward); },
        [this](auto used) { return minimise_with(used); });
  }

  UpdateReport finish(std::span<const Pose> start) override {
    if (mode_ == SolveMode::incremental) return {};
    return solve_from(start.empty() ? poses_ : std::vector<Pose>(start.begin(), start.end()));
  }

  std::optional<LoopDecision> bridge(const Bridge& bridge) override {
    move_behind_hole(bridge, poses_, edges_);
    edges_replaced();
    return std::nullopt;
  }

  std::size_t size() const override { return poses_.size(); }
  Pose pose(std::size_t k) const override { return poses_[k]; }

 protected:
  /// Steps and loops that are used, in order of arrival.
  const std::vector<RelativePose>& edges() const { return edges_; }
  const std::vector<Pose>& poses() const { return poses_; }

  /// Minimises F over `poses`, of which there are two or more, from where they are. All edges are
  /// finite. The map may end elsewhere as a whole. On failure `poses` may be anything.
  virtual UpdateReport solve(std::vector<Pose>& poses) = 0;
  /// edges() are others than at the last solve, and not only more.
  virtual void edges_replaced() {}

 private:
  UpdateReport minimise_with(std::span<const RelativePose> loops) {
    const std::size_t before = edges_.size();
    edges_.insert(edges_.end(), loops.begin(), loops.end());
    if (mode_ == SolveMode::batch) return {};
    const UpdateReport solved = solve_from(poses_);
    if (is_done(solved.outcome)) return solved;
    edges_.resize(before);
    edges_replaced();
    return solved;
  }

  UpdateReport solve_from(std::vector<Pose> poses) {
    UpdateReport report;
    if (edges_.empty() || poses.size() < 2) return report;
    // Solvers take a NaN for no improvement, and report that they have converged.
    const bool finite = std::ranges::all_of(edges_, [](const RelativePose& z) {
      return is_finite(z.motion) && z.information.allFinite();
    });
    if (finite) {
      report = solve(poses);
      put_node_0_back(poses);
    }
    if (!finite || !std::ranges::all_of(poses, [](const Pose& X) { return is_finite(X); })) {
      report.outcome = Outcome::numerical_failure;
    }
    if (is_done(report.outcome)) poses_ = std::move(poses);
    return report;
  }

  /// Some solvers begin by putting it at the origin, or keep it where a given start has it. No edge
  /// says where the map is, so that it moves as a whole.
  void put_node_0_back(std::vector<Pose>& poses) const {
    if (poses[0] == poses_[0]) return;
    const Pose back = compose(poses_[0], inverse(poses[0]));
    for (Pose& pose : poses) pose = compose(back, pose);
    poses[0] = poses_[0];
  }

  SolveMode mode_;
  Gate gate_;
  std::vector<Pose> poses_;
  std::vector<RelativePose> edges_;
};

/// Throws InputError for a gate where there is no innovation: in batch mode, or with a solver
/// without covariances.
inline void check_gate(const GateOptions& gate, const EstimatorSetup& setup, bool has_covariances) {
  if (!gate.probability) return;
  if (!has_covariances) {
    throw InputError("gate_probability: there is no covariance to gate with; use off");
  }
  if (setup.mode == SolveMode::batch) {
    throw InputError(
        "gate_probability: a batch solve has no innovation to gate; use the incremental mode");
  }
}

}  // namespace fathom
