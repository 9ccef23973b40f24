#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "fathom/estimation/estimator.hpp"
#include "fathom/estimation/registry.hpp"
#include "fathom/estimation/stretches.hpp"

namespace fathom {

/// The first loop over a hole, or the first heading behind it.
struct Bridge {
  std::size_t node = 0;              ///< the hole is the step to it
  std::optional<RelativePose> loop;  ///< forward, of full rank; one end of it moves
  Pose motion;                       ///< of the nodes that move, in the axes of their poses
  std::vector<bool> moves;           ///< of every node, whether the hole alone holds it to node 0
  /// All steps that are holes, by the node after each; this one is among them.
  std::span<const std::size_t> holes;
};

/// Whether a step is a hole whose declared heading is so wide (σ above half a radian) that its
/// covariance does not say what its error does to others.
bool is_open_hole(const RelativePose& step);

/// An estimator that knows motions between nodes alone, node 0 fixed: what a pose graph or a filter
/// on motions is by itself. AnchoredEstimator makes it a whole one, so that absolute measurements
/// and an uncertain start need no code of its own. Its axes are those of the world with their
/// origin at node 0, so that no digit and no tolerance is spent on where the map lies.
///
/// As of Estimator, with nodes for keyframes, and
/// - Loops from node 0 may have information that is positive semi-definite (rows_of): all that is
///   measured of the world is one of these.
/// - In batch mode a step that is a hole has no part in the estimate.
class RelativeEstimator : public Estimate {
 public:
  virtual void add_keyframe(const RelativePose& step) = 0;
  /// Loops between the newest node and earlier ones; one decision for each.
  virtual UpdateReport close_loops(std::span<const RelativePose> loops) = 0;
  virtual UpdateReport finish(std::span<const Pose> start = {}) {
    (void)start;
    return {};
  }

  /// Moves nodes as one, so that the loop or the heading is met exactly; what is known of the
  /// motions among them stays. Without this it would be linearised at a guess that may be off by
  /// any turn.
  ///
  /// A graph goes on from there: what was measured is still to be given to close_loops
  /// (std::nullopt), and so is a heading. In a filter a loop takes the place of the hole, whose
  /// declared covariance is forgotten, and is decided here: a gate may reject it by that
  /// covariance, and then nothing changes.
  ///
  /// By default nothing moves: the loop is linearised where dead reckoning's guess leads.
  virtual std::optional<LoopDecision> bridge(const Bridge& bridge) {
    (void)bridge;
    return std::nullopt;
  }
};

/// Makes a RelativeEstimator whose node 0 is at the start's pose.
using MakeRelative = std::function<std::unique_ptr<RelativeEstimator>(const EstimatorSetup&)>;

/// A RelativeEstimator in the world (docs/absolute_measurements.md), shifted there from (0, 0),
/// where its node 0 is.
///
/// With a fixed start node k is keyframe k. An absolute measurement A of keyframe k is a loop from
/// node 0 with Z = X_0⁻¹ A and the same Ω: the residual is the same. With an uncertain start node 0
/// is a frame at the start's pose, known exactly, from which a step of no motion with the start's
/// covariance leads to node 1, keyframe 0; with a free start that step is a hole, and in batch mode
/// the frame is at the first position that is measured, which may be far from the start's pose.
///
/// A measurement that the coordinates in the world do not resolve is lost (precision.hpp): its
/// cost, which is that of these, would be rounding.
///
/// The first loop over an open hole says where the map goes on: the hole is bridged by it. Other
/// holes are steps like others.
class AnchoredEstimator final : public Estimator {
 public:
  AnchoredEstimator(const EstimatorSetup& setup, const MakeRelative& make);

  void add_keyframe(const RelativePose& step) override;
  UpdateReport update(const Measurements& measurements) override;
  UpdateReport finish(std::span<const Pose> start) override;

  std::size_t size() const override { return relative_->size() - shift_; }
  Pose pose(std::size_t k) const override {
    const Pose X = relative_->pose(k + shift_);
    return {X.x + node_0_.x, X.y + node_0_.y, X.theta};
  }
  MovedPoses moved_since(std::uint64_t revision) const override;
  std::optional<std::vector<UncertainPose>> motions_to_newest() const override;
  std::optional<Eigen::Matrix3d> covariance(std::size_t k) const override {
    return relative_->covariance(k + shift_);
  }
  std::optional<Eigen::Matrix3d> newest_covariance() const override {
    return relative_->newest_covariance();
  }
  std::optional<Eigen::MatrixXd> joint_covariance(
      std::span<const std::size_t> keyframes) const override;
  double loss(double chi2, int rank) const override { return relative_->loss(chi2, rank); }
  bool estimates_shared_errors() const override { return relative_->estimates_shared_errors(); }
  std::vector<double> loop_weights() const override { return weights_of(false); }
  std::vector<double> absolute_weights() const override { return weights_of(true); }

  const RelativeEstimator& relative() const { return *relative_; }

 private:
  /// A measurement, and what it weighs where it was not passed on.
  struct Given {
    bool is_absolute = false;
    std::optional<double> weight;
  };

  bool says_something(const AbsolutePose& z) const;
  RelativePose shifted(RelativePose z) const;
  RelativePose from_node_0(const AbsolutePose& z) const;
  void place_frame(std::span<const AbsolutePose> absolute);
  bool are_resolved_in_world(const Measurements& measurements) const;
  void note_given(const Measurements& measurements, bool are_refused);
  UpdateReport refused(const Measurements& measurements) const;
  UpdateReport passed_on(const Measurements& measurements);
  UpdateReport close_loops(std::span<const RelativePose> loops);
  std::optional<LoopDecision> bridge_by(const RelativePose& loop);
  Bridge bridge_of(std::size_t hole, const RelativePose& loop) const;
  std::vector<double> weights_of(bool absolute) const;

  std::unique_ptr<RelativeEstimator> relative_;
  Pose node_0_;
  bool is_batch_;
  bool is_frame_placed_;  ///< where node 0 is in the world stays
  std::size_t shift_ = 0;
  Stretches stretches_;             ///< of nodes; not in batch
  std::vector<std::size_t> holes_;  ///< nodes after holes, rising; not in batch
  std::vector<Given> given_;        ///< every measurement, in the order given
};

/// As of make_entry, for a RelativeEstimator: `make` takes (const EstimatorSetup&, const Options&).
template <class Options, class Make>
EstimatorEntry make_relative_entry(std::string name, std::string help, bool can_batch, Make make) {
  return make_entry<Options>(
      std::move(name), std::move(help), can_batch,
      [make](const EstimatorSetup& setup, const Options& options) {
        return std::make_unique<AnchoredEstimator>(
            setup, [&](const EstimatorSetup& relative) { return make(relative, options); });
      });
}

}  // namespace fathom
