#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "fathom/evaluation/alignment.hpp"
#include "fathom/geometry/pose.hpp"

namespace fathom {

/// How far an estimate is from its reference, over all keyframes with keyframe 0 among them.
struct Accuracy {
  Alignment alignment = Alignment::none;
  Pose motion_reference_estimate;      ///< what the alignment applied
  double mean_position_error_m = 0.0;  ///< mean Euclidean distance: the error of the paper
  double ate_rmse_m = 0.0;             ///< root mean square distance (absolute trajectory error)
  double max_position_error_m = 0.0;
  double final_position_error_m = 0.0;  ///< at the last keyframe
  double heading_rmse_rad = 0.0;        ///< of wrapped heading differences
};

/// Whether so many poses have an error that the alignment leaves: with `none` every pose has, but
/// `origin` and `se2` lay a single pose on its reference, so that its error says nothing.
bool leaves_an_error(std::size_t poses, Alignment alignment);

/// Absolute accuracy after the alignment named. Nothing where it leaves no error
/// (leaves_an_error), where any pose of either list is not finite or where an error is too large
/// for a double: no keyframe is ever left out to save a mean.
/// Throws InputError where the lists differ in length or are empty.
std::optional<Accuracy> accuracy(std::span<const Pose> estimate, std::span<const Pose> reference,
                                 Alignment alignment);

/// Distance in metres at every keyframe, without any alignment. NaN where a pose is.
/// Throws InputError where the lists differ in length.
std::vector<double> position_errors_m(std::span<const Pose> estimate,
                                      std::span<const Pose> reference);

/// Heading difference, estimate − reference, wrapped to (−π, π], at every keyframe.
std::vector<double> heading_errors_rad(std::span<const Pose> estimate,
                                       std::span<const Pose> reference);

/// Relative pose error: how the motion between two keyframes differs from the reference's,
/// E = ⊖(⊖R_i ⊕ R_j) ⊕ (⊖X_i ⊕ X_j) (Sturm et al. 2012). No alignment changes it.
struct RelativeError {
  std::size_t pairs = 0;
  double translation_mean_m = 0.0;  ///< |E.x, E.y|, not divided by the distance
  double translation_rmse_m = 0.0;
  double rotation_mean_rad = 0.0;  ///< |E.θ|
  double rotation_rmse_rad = 0.0;
};

/// Over all pairs (k, k + separation). Nothing where there is no such pair, where any pose of
/// either list is not finite, or where an error is too large for a double. Throws InputError on
/// lists of different length or a separation of zero.
std::optional<RelativeError> relative_error(std::span<const Pose> estimate,
                                            std::span<const Pose> reference,
                                            std::size_t separation_keyframes);

/// Over all pairs (k, first keyframe whose path length along the reference from k reaches
/// `distance_m`). Nothing as above. Throws InputError on lists of different length or a distance
/// that is not positive.
std::optional<RelativeError> relative_error_over(std::span<const Pose> estimate,
                                                 std::span<const Pose> reference,
                                                 double distance_m);

}  // namespace fathom
