#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "fathom/core/options.hpp"
#include "fathom/geometry/pose.hpp"
#include "fathom/vision/features.hpp"
#include "fathom/vision/matching.hpp"
#include "fathom/vision/ransac.hpp"

namespace fathom {

/// What the residuals of one pair cannot show, because all its inliers share it: a tilt, an error
/// of the altimeter, a floor that is not flat. Added as variances, independent in x, y and heading.
struct CovarianceFloor {
  double sigma_m = 0.002;
  double sigma_rad = 0.001;

  void describe(OptionTable& table);
};

struct RegistrationOptions {
  MatchingOptions matching;
  RansacOptions ransac;
  CovarianceFloor covariance_floor;

  void describe(OptionTable& table);
};

/// The motion between two pictures, or why there is none.
struct Registration {
  bool found = false;
  Pose motion;  ///< pose of `to` in the frame of `from`
  /// Of (x, y, θ), that is, of ν = z − h(x): additive, in axes of `from`. Positive definite.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  std::vector<Match> matches;  ///< all that matching gave, one per place
  std::vector<int> inliers;    ///< indices into `matches` of those that agree with the motion
  double rms_m = 0.0;          ///< of the inliers' errors
  int e = 0, ef = 0, fp = 0, nearest = 0, support = 0, places = 0, rival = 0, rival_places = 0;
  double log10_false_alarms = 0.0;
  std::string reason;          ///< of not found, such as "7 of 31 matches agree, 12 are needed"
};

/// Registers two pictures: matching, RANSAC, covariance.
Registration register_pair(const FloorFeatures& from, const FloorFeatures& to,
                           const RegistrationOptions& options, std::uint64_t seed);

}  // namespace fathom
