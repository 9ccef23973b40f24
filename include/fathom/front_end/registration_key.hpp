#pragma once

#include <cstdint>

#include "fathom/core/hash.hpp"
#include "fathom/front_end/registration_cache.hpp"
#include "fathom/vision/camera.hpp"
#include "fathom/vision/features.hpp"
#include "fathom/vision/registration.hpp"

namespace fathom {

/// Raise it whenever the same pictures and options register otherwise than before: a change of
/// features, matching, RANSAC, the decision, the covariance or the seeds.
inline constexpr int kRegistrationVersion = 3;

/// A picture as a registration sees it.
struct SeenPicture {
  std::uint64_t picture_id = 0;  ///< as of FrameSource
  double altitude_m = 0.0;       ///< as measured
};

/// The keys of registrations with one camera and one set of options: of every option that is
/// described, by its key and value, and of OpenCV's version, whose features these are.
class RegistrationKeys {
 public:
  RegistrationKeys(const CameraModel& camera, FeatureOptions features,
                   RegistrationOptions registration);

  RegistrationKey of(const SeenPicture& from, const SeenPicture& to, std::uint64_t pair_seed) const;

 private:
  Hash first_;
  Hash second_;
};

}  // namespace fathom
