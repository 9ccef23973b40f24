#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "fathom/measurements/measurement_log.hpp"

namespace fathom {

/// A registration as it closes a cycle: beside the way between its keyframes that was known best
/// before, over steps and the registrations of earlier keyframes. Best is the least variance of
/// heading, as headings bend a map.
struct LoopClosure {
  std::size_t from = 0;
  std::size_t to = 0;
  double way_m = 0.0;  ///< length of the way
  /// ν = z − h of the way, in the axes of `from`, heading wrapped.
  Eigen::Vector3d misfit = Eigen::Vector3d::Zero();
  /// Of ν, first order: that of the way and of the registration.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();
  double own_sigma_m = 1.0;  ///< of the registration alone, in its worse direction

  double misfit_m() const { return misfit.head<2>().norm(); }
  double misfit_rad() const;
  double sigma_m() const;  ///< predicted, in the worse direction
  double sigma_rad() const;
  double nis() const;  ///< νᵀ covariance⁻¹ ν; 3 expected
};

/// In order of arrival. A registration over a hole that nothing crosses yet closes nothing.
std::vector<LoopClosure> loop_closures(const MeasurementLog& log);

/// What of a log says which back end suits it (docs/which_back_end.md): all from measurements, none
/// from an estimate.
struct LoopTerms {
  std::size_t keyframes = 0;
  std::size_t loops = 0;    ///< that close a cycle; without one the rest is zero
  double longest_m = 0.0;   ///< way of the longest
  LoopClosure most_turned;  ///< that of the largest misfit of heading
  LoopClosure most_moved;   ///< and of position
  /// How many of its σ the worst loop would still miss by after one linearisation: ½ L Θ² / σ, with
  /// L the way, Θ the misfit of heading, σ that of the registration. σ is scaled by what the median
  /// NIS of the loops says, as recorded covariances are often all too large or too small.
  double curvature = 0.0;

  double loops_per_keyframe() const {
    return static_cast<double>(loops) / static_cast<double>(keyframes);
  }
};

/// Fewer loops set no scale of σ: a median of few is chance (as estimator.truncated.scale_loops).
inline constexpr std::size_t kLoopsForScale = 10;

LoopTerms loop_terms(const MeasurementLog& log);

}  // namespace fathom
