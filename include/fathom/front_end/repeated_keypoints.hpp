#pragma once

#include <span>
#include <vector>

#include "fathom/measurements/measurement_log.hpp"
#include "fathom/vision/camera.hpp"

namespace fathom {

/// By registration of a log, in order of arrival: (1 + m) / 2, m the mean number of registrations
/// that a keypoint of its matches takes part in, itself included.
///
/// A keypoint is measured once in its picture, with an error that all its matches share. Of N
/// pictures of the same keypoints the N (N − 1) / 2 registrations tell no more than N − 1 of them,
/// and as independent ones they would be N / 2 = (1 + m) / 2 times too certain
/// (docs/registration.md).
///
/// Keypoints are taken to lie all over what two pictures have in common, by the registered motion,
/// and to be matched in another registration as often as its inliers are dense, against the densest
/// of the picture.
std::vector<double> repeats_of_keypoints(const MeasurementLog& log, const Camera& camera,
                                         std::span<const Stance> stances);

/// The log with each registration's own covariance so many times as large.
MeasurementLog count_keypoints_once(const MeasurementLog& log, std::span<const double> repeats);

}  // namespace fathom
