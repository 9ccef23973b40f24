#include "settings.hpp"

#include <algorithm>
#include <numbers>

namespace fathom::benchmarks {

RegistrationOptions registration_options_for(const test::Condition& condition) {
  // A field of heights that departs from its mean by relief_m at most has a third of that as its
  // deviation, and slopes as a tilt of relief_share would make them.
  RegistrationOptions options;
  options.covariance.altitude_sigma_m = condition.relief_m() / 3.0;
  options.covariance.tilt_sigma_rad =
      std::max(condition.tilt_sigma_rad, condition.relief_share / 3.0);
  return options;
}

WrongLimits wrong_limits(const test::Condition& condition, double metres_per_pixel) {
  constexpr double kPixels = 5.0;
  constexpr double kHeadingRad = 0.02;
  const double tilts = 4.0 * std::numbers::sqrt2 * condition.tilt_sigma_rad;
  return {kPixels * metres_per_pixel + tilts * test::kNominalAltitudeM + condition.relief_m(),
          kHeadingRad + condition.tilt_sigma_rad + condition.relief_share};
}

}  // namespace fathom::benchmarks
