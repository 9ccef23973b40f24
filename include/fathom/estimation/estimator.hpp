#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "fathom/geometry/trajectory.hpp"
#include "fathom/measurements/absolute_pose.hpp"
#include "fathom/measurements/decision.hpp"
#include "fathom/measurements/relative_pose.hpp"

namespace fathom {

/// What is measured of the newest keyframe.
struct Measurements {
  std::span<const RelativePose> registrations;
  std::span<const AbsolutePose> absolute{};

  bool is_empty() const { return registrations.empty() && absolute.empty(); }
};

/// The report of one update or solve.
struct UpdateReport {
  Outcome outcome = Outcome::converged;
  /// Linearisations made.
  int iterations = 0;
  /// One per registration given, in the order given.
  std::vector<LoopDecision> loops;
  /// One per absolute measurement given, in the order given.
  std::vector<AbsoluteDecision> absolute{};
  /// Of a solver that says so: the largest absolute element of the gradient of the cost, in metres
  /// and radians, at the estimate.
  std::optional<double> gradient_norm = std::nullopt;
  /// Likewise: whether the exact Hessian of the cost is positive definite there, that is, a strict
  /// local minimum and no saddle.
  std::optional<bool> is_local_minimum = std::nullopt;
};

/// An estimate of the poses of all keyframes and what it says of its uncertainty. Covariances are
/// in world axes, first order, given the start: with keyframe 0 fixed, its rows and columns are
/// zero.
class Estimate : public TrajectoryView {
 public:
  /// The joint covariance of the (x, y, θ) of several keyframes, 3m×3m in the order given.
  /// Keyframes may repeat. Nothing where it cannot be computed. Not part of the cost of an update.
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

  /// ρ(eᵀ Ω e): what a registration counts in the cost that this estimator minimises, or an
  /// absolute measurement whose information has so many independent rows. The identity without a
  /// robust loss.
  virtual double loss(double chi2, int rank = 3) const {
    (void)rank;
    return chi2;
  }

  /// Whether what the registrations of a picture share is estimated: the cost that this estimator
  /// minimises is then shared_chi2, and else chi2, of the log.
  virtual bool estimates_shared_errors() const { return false; }

  /// What every registration given so far weighs in the estimate as it is, in the order given: 1 as
  /// it stands, less under a robust loss, 0 where it has no part. Empty: 1 for every one that is
  /// used, 0 for the others.
  virtual std::vector<double> loop_weights() const { return {}; }
};

/// A SLAM back end. Five functions make one: size and pose (of TrajectoryView), add_keyframe,
/// update, joint_covariance. What follows from them has a default that may be overridden; a
/// batch solver overrides finish, too, and one with a robust loss says what it does. One that knows
/// motions between keyframes alone is easier to write as a RelativeEstimator.
///
/// The same calls for a filter and for a graph:
///
///     update(measurements)   of keyframe 0, if it is not fixed and something is measured of it
///     add_keyframe(step)     once per keyframe, in order
///     update(measurements)   with all that is measured of the newest keyframe, if anything is
///     finish()               once, at the end of the log
///
/// Contract, to which `fathom conformance`, and a test over all registered estimators, hold it:
/// - Keyframe 0 is there from the beginning, where the start given to the factory says.
/// - `pose(k)` is in the world frame, heading wrapped; the view is valid after every call.
/// - Registrations may be written either way round; measurements of one call form one update.
/// - The same calls give the same estimate, to the last bit.
/// - `covariance` and `motions_to_newest` say what their defaults say, of that same estimate.
/// - Failure is reported, never thrown, and leaves the estimate as it was before the call;
///   but a hole that a measurement of the call has bridged stays bridged.
class Estimator : public Estimate {
 public:
  /// Appends the next keyframe by its motion from the newest one. Of a hole (RelativePose::is_hole)
  /// the covariance is a declared one, except in batch mode, where it has no part in the estimate.
  virtual void add_keyframe(const RelativePose& step) = 0;

  /// Uses what was measured of the newest keyframe: registrations with earlier ones, and absolute
  /// poses.
  virtual UpdateReport update(const Measurements& measurements) = 0;

  /// Ends the log. In batch mode this is where the whole graph is solved, from `start` (a pose per
  /// keyframe) or, without one, from dead reckoning; else there is nothing left to do.
  virtual UpdateReport finish(std::span<const Pose> start = {}) {
    (void)start;
    return {};
  }

  /// As loop_weights, of every absolute measurement.
  virtual std::vector<double> absolute_weights() const { return {}; }
};

}  // namespace fathom
