#pragma once

#include <vector>

#include <Eigen/Core>

#include "fathom/geometry/pose.hpp"
#include "fathom/vision/registration.hpp"
#include "match_set.hpp"

namespace fathom {

/// A motion fitted to matches, each weighted by its uncertainty.
struct MotionFit {
  Pose motion;
  std::vector<int> inliers;  ///< rising indices of the matches it is fitted to
  double rms_m = 0.0;
};

/// Refits a motion to the matches within `ransac.max_error_m` of it, weighted by 1 /
/// relative_variance. Among those a few agree by chance; so of these only the ones stay whose
/// squared error is within `gate` of the errors' own variance, which is taken from their median.
/// Repeated until nothing changes.
MotionFit fit_motion(const Pose& start, const MatchSet& matches,
                     const RegistrationOptions& options);

/// The covariance of a fit, in total and apart: to first order, the sum of
/// - what the errors show less what those of altitudes and tilts that are told explain, σ² (Σ w
///   JᵀJ)⁻¹ with σ² = Σ w ‖r‖² / (2n − the unknowns), and more where errors of neighbours are
///   alike: times the mean ratio of the cluster-robust covariance (Liang and Zeger 1986; clusters
///   are squares of `cluster_px`) to it, if above 1;
/// - a share of the error of one match, which all of a picture have in common;
/// - that of altitudes and tilts, and the floor, as of the options.
/// All but altitudes and tilts is the registration's own.
void set_covariance(Registration& result, const MotionFit& fit, const MatchSet& matches,
                    const FloorFeatures& from, const FloorFeatures& to,
                    const RegistrationOptions& options);

/// Distances in `from` over those in `to` by the inliers of a fit, and its standard deviation.
struct ScaleCheck {
  double scale = 1.0;
  double sigma = 0.0;
};
ScaleCheck check_scale(const MotionFit& fit, const MatchSet& matches);

}  // namespace fathom
