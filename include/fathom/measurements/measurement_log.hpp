#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "fathom/measurements/absolute_pose.hpp"
#include "fathom/measurements/relative_pose.hpp"

namespace fathom {

/// The measurements that arrive with keyframe k: its dead-reckoning step (odometry edge) from
/// k − 1, the registrations (loop edges) of which k is the later keyframe, and what was measured of
/// its pose in the world; each in order of arrival. Keyframe 0 has absolute ones alone.
struct KeyframeMeasurements {
  RelativePose step;
  std::vector<RelativePose> registrations;
  std::vector<AbsolutePose> absolute;
};

/// The recorded measurements of a survey, in order of arrival: what every estimator is given.
/// Keyframes are 0 … size() − 1; keyframe 0 is where `start` says.
class MeasurementLog {
 public:
  /// Keyframe 0 is fixed at `origin`.
  explicit MeasurementLog(const Pose& origin = {}) : MeasurementLog(StartPose{origin}) {}
  explicit MeasurementLog(const StartPose& start) : start_(start), measurements_(1) {}

  const StartPose& start() const { return start_; }
  void set_start(const StartPose& start) { start_ = start; }
  const Pose& origin() const { return start_.pose; }
  std::size_t size() const { return measurements_.size(); }

  /// Appends the next keyframe. `step` joins size() − 1 and size(); its information matrix is
  /// positive definite (asserted), that of a hole too (RelativePose::is_hole).
  void add_keyframe(const RelativePose& step);
  /// A registration between the newest keyframe and an earlier one.
  void add_registration(const RelativePose& registration);
  /// Of the newest keyframe.
  void add_absolute(const AbsolutePose& measurement);

  /// The measurements of keyframe k; keyframe 0 has no step.
  const KeyframeMeasurements& arrival(std::size_t k) const { return measurements_[k]; }

  std::size_t registration_count() const;
  std::size_t absolute_count() const;
  /// Whether any registration has its errors apart.
  bool tells_shared_errors() const;
  /// Steps that were not measured.
  std::size_t hole_count() const;

  /// Steps and registrations, in order of arrival; holes are left out.
  std::vector<RelativePose> edges() const;

  /// The dead reckoning composed from the origin on; over a hole by its guess.
  std::vector<Pose> odometry() const;

  /// Ids of the keyframes in the file they came from: rising, else 0, 1, 2 …
  std::vector<std::int64_t> ids;
  /// The file's own initial guess of every keyframe, where it gives one.
  std::optional<std::vector<Pose>> guess;
  /// Edges of the file from a pose to itself, which are left out.
  std::size_t self_edges = 0;

 private:
  StartPose start_;
  std::vector<KeyframeMeasurements> measurements_;  ///< of keyframe 0 without a step
};

/// The log with each registration as `change` makes it of it and its place in the order of arrival.
MeasurementLog with_registrations(
    const MeasurementLog& log,
    const std::function<RelativePose(const RelativePose&, std::size_t)>& change);

/// F = Σ eᵀ Ω e over all edges as written, absolute measurements and an uncertain start, no ½: the
/// cost that every estimator is compared by. A hole costs nothing.
double chi2(const MeasurementLog& log, std::span<const Pose> trajectory);

/// Whether registrations are taken as independent, each with its total covariance, or with the
/// errors that those of a picture share as unknowns of their own.
enum class RegistrationErrors { independent, shared };

/// F where the errors of a picture's registrations are known to be shared: minimised over them,
/// Σ (ν − G n)ᵀ own⁻¹ (ν − G n) + Σ nᵀ Σ⁻¹ n, ν = z − h(x). It is νᵀ C⁻¹ ν with C the joint
/// covariance of all registrations (docs/shared_errors.md), and chi2 where nothing is told.
double shared_chi2(const MeasurementLog& log, std::span<const Pose> trajectory);

/// Of what was used: each registration's own part times its weight decides over n, and counts
/// loss(its χ²); one with weight 0 does not count. Steps count, absolute measurements do not.
double shared_chi2_used(const MeasurementLog& log, std::span<const Pose> trajectory,
                        std::span<const double> weights, const std::function<double(double)>& loss);

/// Of each registration that tells its errors apart, in order of arrival: what the n of shared_chi2
/// leaves it, ν − G n (m, m, rad; axes of `from`).
std::vector<Eigen::Vector3d> own_errors(const MeasurementLog& log,
                                        std::span<const Pose> trajectory);

/// chi2 or shared_chi2.
double chi2(const MeasurementLog& log, std::span<const Pose> trajectory, RegistrationErrors errors);

/// The same with each registration's covariance as it is of it alone (RelativePose::alone): what F
/// per degree of freedom is of.
double chi2_alone(const MeasurementLog& log, std::span<const Pose> trajectory,
                  RegistrationErrors errors);

/// How many unknowns the measurements determine: the rank of the Jacobian of their residuals. Three
/// a keyframe but the first, if it is fixed, where neither holes nor a free start leave any open.
double determined_unknowns(const MeasurementLog& log);

/// What F is on average at its minimum if every covariance is right: the rows of the residual,
/// three an edge and an uncertain start, the rank of the information an absolute measurement, less
/// determined_unknowns. The same with shared errors, each of which has a prior. Zero: nothing
/// contradicts anything.
double degrees_of_freedom(const MeasurementLog& log);

/// The part of F that is no edge: absolute measurements and the start.
double absolute_chi2(const MeasurementLog& log, std::span<const Pose> trajectory);

}  // namespace fathom
