#pragma once

#include <cstdint>
#include <optional>

#include "fathom/core/hash.hpp"
#include "fathom/front_end/registration_cache.hpp"
#include "fathom/vision/camera.hpp"
#include "fathom/vision/features.hpp"
#include "fathom/vision/registration.hpp"

namespace fathom {

/// Raise it whenever the same pictures and options register otherwise: a change of features,
/// matching, RANSAC, the decision, the covariance or the seeds; or a fault that may have left wrong
/// registrations in caches. Values of options and of
/// RegistrationTuning need no raise, they are in the key; pinned_registrations_test.cpp tells of
/// the rest.
inline constexpr int kRegistrationVersion = 10;

/// A picture as a registration sees it.
struct SeenPicture {
  std::uint64_t picture_id = 0;  ///< as of FrameSource
  double altitude_m = 0.0;       ///< as measured
  std::optional<MeasuredTilt> tilt = std::nullopt;
  double altitude_sigma_m = 0.0;  ///< as its sensor states it; 0: it states none
};

/// The keys of registrations with one camera and one set of options: of every option and
/// every tuned number that is described, by its key and value, and of OpenCV's version, whose
/// features these are.
class RegistrationKeys {
 public:
  /// `mask`: of all pictures, as of FeatureExtractor; empty: the keys know of none.
  RegistrationKeys(const CameraModel& camera, FeatureOptions features,
                   RegistrationOptions registration, const cv::Mat& mask = {});

  RegistrationKey of(const SeenPicture& from, const SeenPicture& to, std::uint64_t pair_seed) const;

 private:
  Hash first_;
  Hash second_;
};

/// The keys of features with one set of options and tuned numbers, and of OpenCV's version.
class FeatureKeys {
 public:
  FeatureKeys() = default;
  FeatureKeys(FeatureOptions features, FeatureTuning tuning, const cv::Mat& mask);

  RegistrationKey of(std::uint64_t picture_id) const;

 private:
  Hash first_;
  Hash second_;
};

}  // namespace fathom
