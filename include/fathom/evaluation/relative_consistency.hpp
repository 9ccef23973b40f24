#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "fathom/evaluation/keyframe_pairs.hpp"
#include "fathom/evaluation/metric_options.hpp"
#include "fathom/geometry/pose.hpp"

namespace fathom {

/// Which motions a figure of consistency is over.
enum class MotionsOver {
  keyframes,   ///< so many keyframes
  distance_m,  ///< such a distance along the true path
  anchors,     ///< between anchors and all keyframes: so many anchors
  held_out     ///< of held-out loops (HeldOutLoops): so many
};

/// Estimated motions that are judged together, with the covariances that the estimator states.
struct JudgedMotions {
  MotionsOver over = MotionsOver::anchors;
  double amount = 0.0;  ///< keyframes, metres or anchors
  std::vector<KeyframePair> pairs;
  /// Of each pair i → k, that of (x, y, θ) of ⊖X_i ⊕ X_k in the axes of i; empty where they cannot
  /// be had.
  std::vector<Eigen::Matrix3d> covariances = {};
};

/// The pairs of every group that these options name and the reference has, without covariances:
/// keyframes first, then distances, then anchors.
std::vector<JudgedMotions> motions_to_judge(std::span<const Pose> reference,
                                            const MetricOptions& options);

/// Mean NEES of the motions divided by its 3 degrees of freedom: 1 expected, above: overconfident.
/// With h = ⊖X_i ⊕ X_k of the estimate and r that of the reference, e = h − r, heading wrapped, and
/// NEES = eᵀ P⁻¹ e (docs/conventions.md, consistency). No alignment, world frame or gauge changes
/// it: h and P are in the axes of i.
///
/// Nothing where there are no motions or no covariances, where a pose is not finite or a covariance
/// is not positive definite: no pair is ever left out. Throws InputError where lists that belong
/// together differ in length.
std::optional<double> relative_anees(std::span<const Pose> estimate,
                                     std::span<const Pose> reference, const JudgedMotions& motions);

}  // namespace fathom
