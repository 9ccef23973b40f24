#pragma once

#include <string>
#include <vector>

#include "fathom/core/ignored_key.hpp"
#include "fathom/core/options.hpp"
#include "fathom/front_end/candidates.hpp"
#include "fathom/vision/features.hpp"
#include "fathom/vision/registration.hpp"

namespace fathom {

/// What visual odometry says of a motion where consecutive pictures do not register: the last
/// motion again, this uncertain.
struct VisualOdometryFallback {
  double sigma_m = 0.3;
  double sigma_rad = 0.1;
};

struct FrontEndOptions {
  int separation_frames = 10;  ///< a keyframe every so many frames
  CandidateOptions candidates;
  FeatureOptions features;
  RegistrationOptions registration;
  VisualOdometryFallback visual_odometry;

  /// In a config these keys stand under `front_end.`.
  void describe(OptionTable& table);
  /// Of them those that a registration depends on.
  void describe_registration(OptionTable& table);

  /// Keys that the methods chosen have no use for, without `front_end.`.
  std::vector<IgnoredKey> ignored_keys() const;
};

}  // namespace fathom
