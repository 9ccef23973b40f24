#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "fathom/geometry/trajectory.hpp"
#include "fathom/measurements/relative_pose.hpp"

namespace fathom {

/// How an update or a solve ended. Ordered by how bad it is: `worse` takes the later.
enum class Outcome { converged, iteration_limit, diverged, numerical_failure };

std::string name_of(Outcome outcome);
Outcome worse(Outcome a, Outcome b);
/// Converged, or stopped at its iteration limit: the estimate can be used.
bool is_done(Outcome outcome);

/// The decision on one registration: used, rejected by a gate, or lost with an update that failed.
enum class LoopFate { used, rejected, lost };

std::string name_of(LoopFate fate);

struct LoopDecision {
  std::size_t from = 0;
  std::size_t to = 0;
  LoopFate fate = LoopFate::used;
  /// Normalised innovation squared νᵀ S⁻¹ ν (3 degrees of freedom) before the update; absent where
  /// the estimator did not need it.
  std::optional<double> nis;
};

/// The report of one update or solve.
struct UpdateReport {
  Outcome outcome = Outcome::converged;
  /// Linearisations made.
  int iterations = 0;
  /// One per registration given, in the order given.
  std::vector<LoopDecision> loops;
  /// Of a solver that says so: the largest absolute element of the gradient of the cost, in metres
  /// and radians, at the estimate.
  std::optional<double> gradient_norm = std::nullopt;
  /// Likewise: whether the exact Hessian of the cost is positive definite there, that is, a strict
  /// local minimum and no saddle.
  std::optional<bool> is_local_minimum = std::nullopt;
};

/// A SLAM back end. Five functions make one: size and pose (of TrajectoryView), add_keyframe,
/// close_loops, joint_covariance. What follows from them has a default that may be overridden; a
/// batch solver overrides finish, too, and one with a robust loss says what it does.
///
/// The same calls for a filter and for a graph:
///
///     add_keyframe(step)        once per keyframe, in order
///     close_loops(registrations)  with all registrations that end at the newest keyframe, if any
///     finish()                    once, at the end of the log
///
/// Contract, tested over every registered estimator (tests/estimators/conformance_test.cpp):
/// - Keyframe 0 is there from the start, fixed at the origin given to the factory.
/// - `pose(k)` is in the world frame, heading wrapped; the view is valid after every call.
/// - Registrations may be written either way round; those of one call form one update.
/// - The same calls give the same estimate, to the last bit.
/// - `covariance` and `motions_to_newest` say what their defaults say, of that same estimate.
/// - Failure is reported, never thrown, and leaves the estimate as it was before the call.
class Estimator : public TrajectoryView {
 public:
  /// Appends the next keyframe by its motion from the newest one.
  virtual void add_keyframe(const RelativePose& step) = 0;

  /// Uses registrations between the newest keyframe and earlier ones.
  virtual UpdateReport close_loops(std::span<const RelativePose> registrations) = 0;

  /// Ends the log. In batch mode this is where the whole graph is solved, from `start` (a pose per
  /// keyframe) or, without one, from dead reckoning; else there is nothing left to do.
  virtual UpdateReport finish(std::span<const Pose> start = {}) {
    (void)start;
    return {};
  }

  /// The joint covariance of the (x, y, θ) of several keyframes, 3m×3m in the order given: world
  /// axes, first order, keyframe 0 fixed (its rows and columns are zero). Keyframes may repeat.
  /// Nothing where it cannot be computed. Not part of the cost of an update.
  virtual std::optional<Eigen::MatrixXd> joint_covariance(
      std::span<const std::size_t> keyframes) const = 0;

  /// The 3×3 covariance of (x, y, θ) of keyframe k, as of joint_covariance, which is what it is
  /// taken from unless an estimator has a faster way.
  virtual std::optional<Eigen::Matrix3d> covariance(std::size_t k) const;

  /// The 3×3 covariance of (x, y, θ) of the newest keyframe, for whoever asks after every keyframe:
  /// as of joint_covariance, which is what it is taken from unless an estimator has a faster way.
  /// One that linearises again only what has moved by more than it says may take its matrix as it
  /// is.
  virtual std::optional<Eigen::Matrix3d> newest_covariance() const;

  /// As of TrajectoryView, from the joint covariance of each keyframe and the newest unless an
  /// estimator has a faster way.
  std::optional<std::vector<UncertainPose>> motions_to_newest() const override;

  /// ρ(eᵀ Ω e): what a registration counts in the cost that this estimator minimises. The identity
  /// without a robust loss.
  virtual double loss(double chi2) const { return chi2; }

  /// What every registration given so far weighs in the estimate as it is, in the order given: 1 as
  /// it stands, less under a robust loss, 0 where it has no part. Empty: 1 for every one that is
  /// used, 0 for the others.
  virtual std::vector<double> loop_weights() const { return {}; }
};

}  // namespace fathom
