#include "settings.hpp"

#include <numbers>

namespace fathom::benchmarks {

RegistrationOptions registration_options_for(const test::Condition& /*condition*/) {
  return {};
}

WrongLimits wrong_limits(const test::Condition& condition, double metres_per_pixel) {
  constexpr double kPixels = 5.0;
  constexpr double kHeadingRad = 0.02;
  const double tilts = 4.0 * std::numbers::sqrt2 * condition.tilt_sigma_rad;
  return {kPixels * metres_per_pixel + tilts * test::kNominalAltitudeM + condition.relief_m(),
          kHeadingRad + condition.tilt_sigma_rad + condition.relief_share};
}

}  // namespace fathom::benchmarks
