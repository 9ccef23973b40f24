#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "fathom/evaluation/alignment.hpp"
#include "fathom/evaluation/interval.hpp"
#include "fathom/geometry/pose.hpp"

namespace fathom {

/// Consistency of an estimate with its covariances. Keyframe 0, which mostly is fixed and has no
/// covariance, is left out: entry i of a list belongs to keyframe i + 1.
struct Consistency {
  std::vector<double> pose_nees;      ///< eᵀ P⁻¹ e of (x, y, θ): χ² of 3 degrees of freedom
  std::vector<double> position_nees;  ///< the same of (x, y) alone: 2 degrees of freedom
  double anees = 0.0;                 ///< mean pose NEES / 3: 1 expected, above: overconfident
  double position_anees = 0.0;        ///< mean position NEES / 2
  /// Share of keyframes with the true position inside the 2σ ellipse; see kExpectedInside2Sigma.
  double share_inside_2_sigma = 0.0;
};

/// 1 − e⁻²: the share of a planar Gaussian inside its 2σ ellipse.
inline constexpr double kExpectedInside2Sigma = 0.86466471676338731;

/// Normalised estimation error squared (Bar-Shalom, Li and Kirubarajan 2001, section 5.4).
/// `covariances[k]` is that of (x, y, θ) of keyframe k in the world axes of the estimate, keyframe
/// 0 fixed and alignment `origin`, which turns it along with the estimate; of an uncertain start
/// `none`, as the covariance says how far the estimate is off in the world. covariances[0] is not
/// looked at.
///
/// Nothing where there is no keyframe but 0, where a pose of either list is not finite, or where a
/// covariance is not positive definite: one bad keyframe is a bad run, and is never left out.
/// Throws InputError where the three lists differ in length.
std::optional<Consistency> consistency(std::span<const Pose> estimate,
                                       std::span<const Pose> reference,
                                       std::span<const Eigen::Matrix3d> covariances,
                                       Alignment alignment = Alignment::origin);

/// The two-sided interval that holds, with the given probability, the mean over `trials`
/// independent trials of a NEES divided by its degrees of freedom, if the covariances are right:
/// N · dof · anees is χ² of N · dof degrees of freedom. It holds for the trials at one keyframe,
/// not for the keyframes of one run, which are correlated.
/// Throws InputError unless trials and degrees of freedom are at least 1 and 0 < probability < 1.
Interval anees_interval(std::size_t trials, std::size_t degrees_of_freedom, double probability);

}  // namespace fathom
