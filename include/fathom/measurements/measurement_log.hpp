#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "fathom/measurements/relative_pose.hpp"

namespace fathom {

/// The measurements that arrive with keyframe k: its dead-reckoning step (odometry edge) from k − 1
/// and the registrations (loop edges) of which k is the later keyframe, in order of arrival.
struct KeyframeMeasurements {
  RelativePose step;
  std::vector<RelativePose> registrations;
};

/// The recorded measurements of a survey, in order of arrival: what every estimator is given.
/// Keyframes are 0 … size() − 1; keyframe 0 is fixed at `origin`.
class MeasurementLog {
 public:
  explicit MeasurementLog(const Pose& origin = {}) : origin_(origin) {}

  const Pose& origin() const { return origin_; }
  std::size_t size() const { return measurements_.size() + 1; }

  /// Appends the next keyframe. `step` joins size() − 1 and size() and has a positive definite
  /// information matrix (asserted).
  void add_keyframe(const RelativePose& step);
  /// A registration between the newest keyframe and an earlier one.
  void add_registration(const RelativePose& registration);

  /// The measurements of keyframe k, 1 ≤ k < size().
  const KeyframeMeasurements& arrival(std::size_t k) const { return measurements_[k - 1]; }

  std::size_t registration_count() const;

  /// Steps and registrations, in order of arrival.
  std::vector<RelativePose> edges() const;

  /// The dead reckoning composed from the origin on.
  std::vector<Pose> odometry() const;

  /// Ids of the keyframes in the file they came from: rising, else 0, 1, 2 …
  std::vector<std::int64_t> ids;
  /// The file's own initial guess of every keyframe, where it gives one.
  std::optional<std::vector<Pose>> guess;

 private:
  Pose origin_;
  std::vector<KeyframeMeasurements> measurements_;
};

/// F = Σ eᵀ Ω e over all edges as written, no ½: the cost that every estimator is compared by.
double chi2(const MeasurementLog& log, std::span<const Pose> trajectory);

}  // namespace fathom
