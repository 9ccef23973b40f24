#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fathom/core/ignored_key.hpp"
#include "fathom/core/options.hpp"
#include "fathom/front_end/candidates.hpp"
#include "fathom/front_end/keyframes.hpp"
#include "fathom/front_end/picture_use.hpp"
#include "fathom/vision/features.hpp"
#include "fathom/vision/registration.hpp"

namespace fathom {

/// What visual odometry says of a motion where consecutive pictures do not register: the last
/// motion again, this uncertain.
struct VisualOdometryFallback {
  double sigma_altitudes = 0.15;  ///< in x and y, in altitudes
  std::optional<double> sigma_m;  ///< in metres instead
  double sigma_rad = 0.1;
};

/// What is made of keypoints that several registrations have in common.
enum class RepeatedKeypoints {
  once,        ///< own covariances are so much larger that each counts once (repeats_of_keypoints)
  independent  ///< each registration as if its keypoints were its own
};

struct FrontEndOptions {
  KeyframeOptions keyframes;
  CandidateOptions candidates;
  MaskUse mask = MaskUse::automatic;
  FeatureOptions features;
  RegistrationOptions registration;
  RepeatedKeypoints repeated_keypoints = RepeatedKeypoints::once;
  VisualOdometryFallback visual_odometry;

  /// In a config these keys stand under `front_end.`.
  void describe(OptionTable& table);
  /// Of them those that a registration depends on.
  void describe_registration(OptionTable& table);

  /// Throws InputError where options need another one that is not given. Its message begins with
  /// the key as it stands below `front_end`.
  void check() const;

  /// Keys that the methods chosen have no use for, without `front_end.`.
  std::vector<IgnoredKey> ignored_keys() const;
};

}  // namespace fathom
