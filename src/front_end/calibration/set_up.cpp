#include "set_up.hpp"

#include <algorithm>
#include <cmath>

#include "robust_scale.hpp"
#include "set_up_fit.hpp"

namespace fathom {
namespace {

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

struct Found {
  OdometryFormat format;
  bool is_reversed = false;
  SetUpFit fit;
};

// What is configured, unless another reading of the same numbers is far more likely: so much, of
// each motion and of all, that neither one wild motion nor the search among twenty makes it.
std::optional<Found> best_of_all(const CalibrationInput& input) {
  constexpr double kOfAll = 20.0;
  constexpr double kOfEach = 0.1;
  const SetUpPrior prior = prior_of(input);
  const std::vector<SeenMotion> from_the_end = reversed(input);
  std::optional<Found> configured;
  std::optional<Found> best;
  for (const bool is_reversed : {false, true}) {
    for (const bool is_in_degrees : {false, true}) {
      for (const auto& [word, convention] : odometry_conventions()) {
        OdometryFormat format = input.odometry.format;
        const bool is_configured = !is_reversed && is_in_degrees == format.is_in_degrees &&
                                   convention == format.convention;
        format.convention = convention;
        format.is_in_degrees = is_in_degrees;
        const OdometryTrack track(input.odometry, format);
        auto fit = fit_set_up(is_reversed ? from_the_end : input.motions, track, prior);
        if (!fit) continue;
        if (!best || fit->log_density > best->fit.log_density) best = {format, is_reversed, *fit};
        if (is_configured) configured = {format, is_reversed, *fit};
      }
    }
  }
  if (!configured) return best;
  const double gain = best->fit.log_density - configured->fit.log_density;
  const bool is_clear = gain > kOfAll && gain > kOfEach * static_cast<double>(input.motions.size());
  return is_clear ? best : configured;
}

// The one time at which reckoned over registered lengths change, as least absolute deviations have
// it; nothing where they do not, by their spread and by 3 %.
std::optional<SetUp::Step> step_of(const CalibrationInput& input, const SetUpFit& fit) {
  constexpr std::size_t kFewest = 8;
  constexpr double kSigmas = 8.0;
  constexpr double kLeast = 0.05;
  struct Moved {
    double log_ratio = 0.0;
    std::size_t index = 0;
  };
  std::vector<Moved> moved;
  for (const SetUpFit::Motion& motion : fit.each) {
    const double length_m = input.motions[motion.index].camera.position().norm();
    if (motion.length_ratio > 0.0 && length_m > 3.0 * fit.sigma_m) {
      moved.push_back({std::log(motion.length_ratio), motion.index});
    }
  }
  if (moved.size() < 2 * kFewest) return std::nullopt;
  const auto median_of = [&](std::size_t begin, std::size_t end) {
    std::vector<double> values;
    for (std::size_t i = begin; i < end; ++i) values.push_back(moved[i].log_ratio);
    return median(values);
  };
  double least = std::numeric_limits<double>::infinity();
  std::size_t split = 0;
  double before = 0.0;
  double after = 0.0;
  for (std::size_t i = kFewest; i + kFewest <= moved.size(); ++i) {
    const double low = median_of(0, i);
    const double high = median_of(i, moved.size());
    double sum = 0.0;
    for (std::size_t j = 0; j < moved.size(); ++j) {
      sum += std::abs(moved[j].log_ratio - (j < i ? low : high));
    }
    if (sum < least) {
      least = sum;
      split = i;
      before = low;
      after = high;
    }
  }
  std::vector<double> off;
  for (std::size_t j = 0; j < moved.size(); ++j) {
    off.push_back(std::abs(moved[j].log_ratio - (j < split ? before : after)));
  }
  // Of a difference of two medians.
  constexpr double kOfMedian = 1.2533;
  const double sigma =
      kOfMedian * median(off) / kHalfNormalMedian *
      std::sqrt(1.0 / static_cast<double>(split) + 1.0 / static_cast<double>(moved.size() - split));
  const Estimated log_factor{before - after, sigma};
  if (!log_factor.is_off(0.0, kSigmas, kLeast)) return std::nullopt;
  const SeenMotion& first = input.motions[moved[split].index];
  const double factor = std::exp(log_factor.value);
  SetUp::Step step{first.from_ns, {factor, factor * sigma}, 1.0};
  constexpr std::size_t kBeside = 5;
  std::vector<double> low;
  std::vector<double> high;
  const std::size_t count = input.altitudes_m.size();
  for (std::size_t i = first.from - std::min(first.from, kBeside); i <= first.from; ++i) {
    low.push_back(input.altitudes_m[i]);
  }
  for (std::size_t i = first.to; i < std::min(count, first.to + kBeside); ++i) {
    high.push_back(input.altitudes_m[i]);
  }
  step.altitude_factor = median(high) / median(low);
  return step;
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
  const auto found = best_of_all(input);
  if (!found) return std::nullopt;
  const SetUpFit& fit = found->fit;
  const auto estimated = [&fit](int i) {
    return Estimated{fit.value.vector()(i), std::sqrt(fit.covariance(i, i))};
  };
  SetUp set_up;
  set_up.motions = fit.motions;
  set_up.format = found->format;
  set_up.is_reversed = found->is_reversed;
  // A residual that is as long as the motion leaves nothing that the two have in common.
  constexpr double kUnrelated = 0.5;
  set_up.is_related = fit.sigma_m < kUnrelated * fit.median_m;
  const Estimated log_scale = estimated(0);
  const double scale = std::exp(-log_scale.value);
  set_up.scale = {scale, scale * log_scale.sigma};
  set_up.yaw_rad = estimated(1);
  set_up.lever_x_m = estimated(2);
  set_up.lever_y_m = estimated(3);
  set_up.time_offset_s = estimated(4);
  set_up.sigma_m = fit.sigma_m;
  set_up.sigma_rad = fit.sigma_rad;
  if (set_up.is_related) set_up.step = step_of(input, fit);
  return set_up;
}

}  // namespace fathom
