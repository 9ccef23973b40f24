#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "fathom/core/options.hpp"
#include "fathom/geometry/pose.hpp"
#include "fathom/measurements/shared_errors.hpp"
#include "fathom/vision/features.hpp"
#include "fathom/vision/matching.hpp"
#include "fathom/vision/own_covariances.hpp"
#include "fathom/vision/ransac.hpp"
#include "fathom/vision/registration_tuning.hpp"

namespace fathom {

/// When a motion counts as found (docs/registration.md).
struct DecisionOptions {
  enum class Method {
    false_alarms,  ///< a contrario: if chance would seldom bring so many matches together
    inliers        ///< the paper's (figure 2): if it has enough inliers
  };
  Method method = Method::false_alarms;
  double max_false_alarms = 1e-7;
  /// Of false_alarms: so many of the strongest features of either picture are tried first. Where
  /// chance would do as well with these, by `first_max_false_alarms`, no more are looked at.
  std::optional<int> first_features = 1200;
  double first_max_false_alarms = 0.5;

  void describe(OptionTable& table);
};

/// What the residuals of one pair cannot show, because all its matches share it.
struct CovarianceOptions {
  /// Of each altitude, unless its sensor states more; stands for the relief of a floor too. Empty:
  /// where no sensor states it estimated from the survey, 0 until then.
  std::optional<double> altitude_sigma_m = std::nullopt;
  /// Of roll and of pitch, at each picture that does not come with them measured. No vehicle keeps
  /// its camera level: without a word on it, 0.3°. Empty: estimated from the survey; until then,
  /// and where it does not tell, that too. At 0, registrations would be certain to a fraction of a
  /// millimetre.
  static constexpr double kAssumedTiltRad = 0.005;
  std::optional<double> tilt_sigma_rad = std::nullopt;
  /// The standard deviations of a registration's own error are so many times what its residuals
  /// show: relief that each pair sees from other sides, distortion that calibration leaves. Empty:
  /// estimated from the survey, 1 until then.
  std::optional<double> own_factor = std::nullopt;

  double altitude() const { return altitude_sigma_m.value_or(0.0); }
  double own() const { return own_factor.value_or(1.0); }
  double tilt() const { return tilt_sigma_rad.value_or(kAssumedTiltRad); }
  bool is_estimated() const { return !altitude_sigma_m || !tilt_sigma_rad || !own_factor; }
  /// Added to x and y as variances, whatever else is known: in pixels of the picture with the
  /// coarser ones, or in metres.
  double floor_sigma_px = 0.0025;
  std::optional<double> floor_sigma_m = std::nullopt;
  double floor_sigma_rad = 1e-5;  ///< and to the heading

  void describe(OptionTable& table);
};

struct RegistrationOptions {
  MatchingOptions matching;
  RansacOptions ransac;
  DecisionOptions decision;
  CovarianceOptions covariance;
  RegistrationTuning tuning;

  void describe(OptionTable& table);
};

/// What a decision rests on. With the paper's criterion `support` and `places` alone are known.
struct Evidence {
  int support = 0;  ///< inliers of the best motion
  int places = 0;   ///< in which these lie, see ransac(); counted up to 200
  /// The most places of any other motion: of the second-best one, and of those with the heading of
  /// the best one and another translation.
  int rival_places = 0;
  /// The probability of a false alarm, as of a-contrario tests (docs/registration.md): of so many
  /// places by chance, if chance brings together what it does for the strongest rival.
  double false_alarms = 1.0;
  /// Of distances in `from` to those in `to`, by the inliers: 1 where the altitudes are right.
  /// Never applied.
  double scale = 1.0;
  double scale_sigma = 0.0;
};

/// The motion between two pictures, or why there is none.
struct Registration {
  bool found = false;
  Pose motion;  ///< pose of `to` in the frame of `from`
  /// Of (x, y, θ), that is, of ν = z − h(x): additive, in axes of `from`. Positive definite.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  /// The same apart: what its pictures share in all their registrations, n = (altitude, roll,
  /// pitch) of each, and what is its own.
  SharedErrors shared;
  OwnCovariances own;           ///< shared.own, and what it is where loops find other σ
  std::vector<Match> putative;  ///< that passed the ratio test and are mutual, one per place
  std::vector<Match> inliers;   ///< those that agree with the motion; not found: with the best one
  double rms_m = 0.0;           ///< of the inliers' errors
  Evidence evidence;
  std::string reason;  ///< of not found, such as "7 of 31 matches agree, 12 are needed"
};

/// Registers two pictures: the paper's figure 2 with matching before it and the covariance after,
/// and a decision of our own in place of the count of inliers (docs/registration.md).
/// Same arguments, same answer. Throws InputError where features lack their points.
Registration register_pair(const FloorFeatures& from, const FloorFeatures& to,
                           const RegistrationOptions& options, std::uint64_t seed);

}  // namespace fathom
