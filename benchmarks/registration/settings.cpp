#include "settings.hpp"

#include <algorithm>
#include <numbers>
#include <string>

#include "fathom/core/input_error.hpp"

namespace fathom::benchmarks {

namespace {

void set_option(RegistrationOptions& options, const std::string& setting) {
  const std::size_t equals = setting.find('=');
  if (equals == std::string::npos) {
    throw InputError("--set: expected KEY=VALUE, got '" + setting + "'");
  }
  OptionTable table;
  options.describe(table);
  table.set(setting.substr(0, equals), OptionValue::scalar(setting.substr(equals + 1)));
}

}  // namespace

RegistrationOptions registration_options_for(const test::Condition& condition,
                                             const Settings& settings) {
  // What a relief adds to an altitude and to a tilt over the overlap of two pictures: half of its
  // greatest height, and a slope of relief_share.
  RegistrationOptions options;
  // The figures of docs/registration_benchmark.md were made with these, whatever the altitude.
  options.ransac.max_error_m = 0.03;
  options.covariance.floor_sigma_m = 1e-5;
  options.covariance.altitude_sigma_m = condition.relief_m() / 2.0;
  options.covariance.tilt_sigma_rad = std::max(condition.tilt_sigma_rad, condition.relief_share);
  if (settings.plain) {
    options.decision.method = DecisionOptions::Method::inliers;
    options.ransac.min_places = 1;
  }
  for (const std::string& setting : settings.set) set_option(options, setting);
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
