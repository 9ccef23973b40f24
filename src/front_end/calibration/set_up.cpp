#include "set_up.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "fathom/core/median.hpp"
#include "interpolation.hpp"
#include "picture_order.hpp"
#include "residuals.hpp"
#include "scale_step.hpp"
#include "set_up_fit.hpp"

namespace fathom {
namespace {

// As a camera sees it whose pictures are mirrored.
std::vector<SeenMotion> mirrored(std::vector<SeenMotion> motions) {
  for (SeenMotion& motion : motions) {
    motion.camera = {motion.camera.x, -motion.camera.y, -motion.camera.theta};
  }
  return motions;
}

// Of pictures counted from the end.
std::vector<SeenMotion> reversed(const CalibrationInput& input) {
  std::vector<SeenMotion> motions = input.motions;
  const std::size_t last = input.frame_times_ns.size() - 1;
  for (SeenMotion& motion : motions) {
    motion.from_ns = input.frame_times_ns[last - motion.from];
    motion.to_ns = input.frame_times_ns[last - motion.to];
  }
  return motions;
}

SetUpPrior prior_of(const CalibrationInput& input) {
  SetUpPrior prior;
  prior.mean.yaw_rad = input.camera.mount_yaw_rad;
  prior.mean.lever_x_m = input.camera.mount_x_m;
  prior.mean.lever_y_m = input.camera.mount_y_m;
  return prior;
}

struct Reading {
  OdometryFormat format;
  bool is_reversed = false;
  bool is_mirrored = false;
};

std::vector<SeenMotion> motions_of(const CalibrationInput& input, const Reading& reading) {
  std::vector<SeenMotion> motions = reading.is_reversed ? reversed(input) : input.motions;
  return reading.is_mirrored ? mirrored(std::move(motions)) : motions;
}

// All ways to read the same numbers.
std::vector<Reading> readings_of(const OdometryFormat& configured) {
  std::vector<Reading> readings{{configured, false, false}};
  // Of each other convention the mirror image is one, too.
  if (mirrored(configured.convention) == configured.convention) {
    readings.push_back({configured, false, true});
  }
  for (const bool is_reversed : {false, true}) {
    for (const bool is_in_degrees : {false, true}) {
      for (const auto& named : odometry_conventions()) {
        const bool is_configured = !is_reversed && is_in_degrees == configured.is_in_degrees &&
                                   named.second == configured.convention;
        if (is_configured) continue;
        readings.push_back({{named.second, is_in_degrees, configured.scale}, is_reversed, false});
      }
    }
  }
  return readings;
}

// Headings that are made 57 times smaller have residuals so much smaller, which says nothing for
// them: the density is of the numbers as they are.
double density_of_unit(const OdometryFormat& format, std::size_t motions) {
  return format.is_in_degrees ? static_cast<double>(motions) * std::log(std::numbers::pi / 180.0)
                              : 0.0;
}

// How likely numbers are that are read so. Of two
// that say the same, such as headings from x and from y with the camera turned, the one with less
// to be changed counts.
double evidence_of(const Reading& reading, const SetUpFit& fit, const SetUpPrior& prior,
                   const CalibrationInput& input) {
  constexpr double kTurned_rad = 0.1;
  constexpr double kOfTurned = 5.0;
  constexpr double kOfConvention = 1.0;
  const std::size_t motions = input.motions.size();
  double evidence = fit.most_log_density + density_of_unit(reading.format, motions);
  const double yaw_rad = wrap_angle(fit.value.yaw_rad - prior.mean.yaw_rad);
  if (std::abs(yaw_rad) > kTurned_rad) evidence -= kOfTurned;
  if (reading.format.convention != input.odometry.format.convention) evidence -= kOfConvention;
  return evidence;
}

bool turns_against_truth(const CalibrationInput& input, const OdometryFormat& format) {
  return compare_with_truth(input, OdometryTrack(input.odometry, format)).slope.value < 0.0;
}

// Whether ground truth turns the other way than dead reckoning read so. Nothing else tells a survey
// in reverse order from one whose headings count the other way, where its way is even. The mirror
// image of what is configured stands for mirrored pictures, too: ground truth does not know these.
bool contradicts_truth(const CalibrationInput& input, const Reading& reading) {
  const OdometryFormat& configured = input.odometry.format;
  const bool is_of_mirrored_pictures = !reading.is_reversed &&
                                       reading.format.is_in_degrees == configured.is_in_degrees &&
                                       reading.format.convention == mirrored(configured.convention);
  return turns_against_truth(input, reading.format) &&
         (!is_of_mirrored_pictures || turns_against_truth(input, configured));
}

struct FittedReading {
  Reading reading;
  SetUpFit fit;
};

// What is configured, unless another reading is far more likely: so much, of each motion and of
// all, that neither one wild motion nor the search among twenty makes it. Each with its own clock:
// one that lay beside it would lose to a wrong reading of an even motion.
std::optional<FittedReading> best_reading(const CalibrationInput& input, const SetUpPrior& prior) {
  constexpr double kOfAll = 20.0;
  constexpr double kOfEach = 0.1;
  std::optional<FittedReading> best;
  double most = -std::numeric_limits<double>::infinity();
  double margin = kOfAll + kOfEach * static_cast<double>(input.motions.size());
  for (const Reading& reading : readings_of(input.odometry.format)) {
    const std::vector<SeenMotion> motions = motions_of(input, reading);
    const auto fit = fit_set_up(motions, OdometryTrack(input.odometry, reading.format), prior);
    if (!fit) continue;
    constexpr double kOfTruth = 50.0;
    double evidence = evidence_of(reading, *fit, prior, input) -
                      gain_of_interpolation(input.odometry, motions, fit->value.time_offset_s);
    if (contradicts_truth(input, reading)) evidence -= kOfTruth;
    // The first one is what is configured.
    if (!best) evidence += std::exchange(margin, 0.0);
    if (best && !(evidence > most)) continue;
    best = FittedReading{reading, *fit};
    most = evidence;
  }
  return best;
}

// Pictures that belong elsewhere, under the reading that was found, or else under the configured
// one, which it may have stood in for; `reading` and `fit` are of them in their places then.
std::vector<MovedPictures> put_right(const CalibrationInput& input, const SetUpPrior& prior,
                                     Reading& reading, SetUpFit& fit) {
  const double evidence = evidence_of(input, fit);
  const auto try_with = [&](const OdometryFormat& format,
                            const std::vector<SetUpParameters>& starts) {
    const OdometryTrack track(input.odometry, format);
    const double of_unit = density_of_unit(reading.format, input.motions.size()) -
                           density_of_unit(format, input.motions.size());
    auto moved = find_moved(input, track, prior, starts, evidence + of_unit);
    const auto fitted =
        moved.empty() ? std::nullopt : fit_set_up(put_in_place(input, moved), track, prior);
    if (!fitted) return std::vector<MovedPictures>{};
    reading = {format, false, false};
    fit = *fitted;
    return moved;
  };
  std::vector<MovedPictures> moved;
  const bool is_as_taken = !reading.is_reversed && !reading.is_mirrored;
  if (is_as_taken) moved = try_with(reading.format, {fit.value, prior.mean});
  const OdometryFormat& configured = input.odometry.format;
  const bool is_configured = is_as_taken && reading.format.convention == configured.convention &&
                             reading.format.is_in_degrees == configured.is_in_degrees;
  if (moved.empty() && !is_configured) moved = try_with(configured, {prior.mean});
  return moved;
}

}  // namespace

OdometryConvention mirrored(OdometryConvention convention) {
  switch (convention) {
    case OdometryConvention::counter_clockwise_from_x:
      return OdometryConvention::north_east_down;
    case OdometryConvention::north_east_down:
      return OdometryConvention::counter_clockwise_from_x;
    case OdometryConvention::clockwise_from_x:
      return OdometryConvention::y_to_starboard;
    case OdometryConvention::y_to_starboard:
      return OdometryConvention::clockwise_from_x;
    case OdometryConvention::clockwise_from_y:
      break;
  }
  return convention;
}

std::optional<SetUp> find_set_up(const CalibrationInput& input) {
  if (input.motions.empty() || input.odometry.rows.size() < 2) return std::nullopt;
  const SetUpPrior prior = prior_of(input);
  auto best = best_reading(input, prior);
  if (!best) return std::nullopt;
  SetUp set_up;
  set_up.moved = put_right(input, prior, best->reading, best->fit);
  const Reading& found = best->reading;
  const SetUpFit& fit = best->fit;
  const auto estimated = [&fit](int i) {
    return Estimated{fit.value.vector()(i), std::sqrt(fit.covariance(i, i))};
  };
  set_up.motions = fit.motions;
  set_up.format = found.format;
  set_up.is_reversed = found.is_reversed;
  set_up.is_mirrored = found.is_mirrored;
  const Estimated log_scale = estimated(0);
  const double scale = std::exp(-log_scale.value);
  set_up.scale = {scale, scale * log_scale.sigma};
  set_up.least_scale = fit.least_scale;
  // A residual that is as long as the motion leaves nothing that the two have in common, unless
  // they are correlated all the same: R² is about the ratio of both scales.
  constexpr double kUnrelated = 0.5;
  set_up.is_related =
      fit.sigma_m < kUnrelated * fit.median_m || set_up.least_scale.value > kUnrelated * scale;
  set_up.yaw_rad = estimated(1);
  set_up.lever_x_m = estimated(2);
  set_up.lever_y_m = estimated(3);
  set_up.time_offset_s = estimated(4);
  set_up.sigma_m = fit.sigma_m;
  set_up.sigma_rad = fit.sigma_rad;
  if (set_up.is_related) set_up.step = find_step_of_scale(input, fit);
  return set_up;
}

}  // namespace fathom
