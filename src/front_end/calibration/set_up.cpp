#include "set_up.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

#include "fathom/core/median.hpp"
#include "set_up_fit.hpp"
#include "student_t.hpp"

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

struct Reading {
  OdometryFormat format;
  bool is_reversed = false;
};

// All ways to read the same numbers.
std::vector<Reading> readings_of(const OdometryFormat& configured) {
  std::vector<Reading> readings{{configured, false}};
  for (const bool is_reversed : {false, true}) {
    for (const bool is_in_degrees : {false, true}) {
      for (const auto& named : odometry_conventions()) {
        const bool is_configured = !is_reversed && is_in_degrees == configured.is_in_degrees &&
                                   named.second == configured.convention;
        if (is_configured) continue;
        readings.push_back({{named.second, is_in_degrees, configured.scale}, is_reversed});
      }
    }
  }
  return readings;
}

// How likely numbers are that are read so. Headings that are made 57 times smaller have residuals
// so much smaller, which says nothing for them: the density is of the numbers as they are. Of two
// that say the same, such as headings from x and from y with the camera turned, the one with less
// to be changed counts.
double evidence_of(const Reading& reading, const SetUpStart& start, const SetUpPrior& prior,
                   std::size_t motions) {
  constexpr double kTurned_rad = 0.1;
  constexpr double kOfTurned = 5.0;
  double evidence = start.log_density;
  if (reading.format.is_in_degrees) {
    evidence += static_cast<double>(motions) * std::log(std::numbers::pi / 180.0);
  }
  const double yaw_rad = wrap_angle(start.value.yaw_rad - prior.mean.yaw_rad);
  if (std::abs(yaw_rad) > kTurned_rad) evidence -= kOfTurned;
  return evidence;
}

// What is configured, unless another reading is far more likely: so much, of each motion and of
// all, that neither one wild motion nor the search among twenty makes it.
std::optional<Reading> best_reading(const CalibrationInput& input, const SetUpPrior& prior) {
  constexpr double kOfAll = 20.0;
  constexpr double kOfEach = 0.1;
  const std::vector<SeenMotion> from_the_end = reversed(input);
  std::optional<Reading> best;
  double most = -std::numeric_limits<double>::infinity();
  double margin = kOfAll + kOfEach * static_cast<double>(input.motions.size());
  for (const Reading& reading : readings_of(input.odometry.format)) {
    const auto start = start_set_up(reading.is_reversed ? from_the_end : input.motions,
                                    OdometryTrack(input.odometry, reading.format), prior);
    if (!start) continue;
    double evidence = evidence_of(reading, *start, prior, input.motions.size());
    // The first one is what is configured.
    if (!best) evidence += std::exchange(margin, 0.0);
    if (best && !(evidence > most)) continue;
    best = reading;
    most = evidence;
  }
  return best;
}

// Of the altitudes before a motion and after it, in the median of some.
double altitude_factor_at(const CalibrationInput& input, const SeenMotion& motion) {
  constexpr std::size_t kBeside = 5;
  std::vector<double> low;
  std::vector<double> high;
  for (std::size_t i = motion.from - std::min(motion.from, kBeside); i <= motion.from; ++i) {
    low.push_back(input.altitudes_m[i]);
  }
  for (std::size_t i = motion.to; i < std::min(input.altitudes_m.size(), motion.to + kBeside);
       ++i) {
    high.push_back(input.altitudes_m[i]);
  }
  return upper_median(high) / upper_median(low);
}

// A series that has one level up to an index, and another from there on.
struct TwoLevels {
  std::size_t split = 0;
  double before = 0.0;
  double after = 0.0;
  double sigma = 0.0;  // of their difference
};

// By least absolute deviations, with so many on either side.
TwoLevels two_levels(const std::vector<double>& values, std::size_t fewest) {
  const auto median_of = [&values](std::size_t begin, std::size_t end) {
    return upper_median({values.begin() + static_cast<std::ptrdiff_t>(begin),
                         values.begin() + static_cast<std::ptrdiff_t>(end)});
  };
  TwoLevels best;
  std::vector<double> least_off;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t split = fewest; split + fewest <= values.size(); ++split) {
    const TwoLevels levels{split, median_of(0, split), median_of(split, values.size()), 0.0};
    std::vector<double> off;
    off.reserve(values.size());
    for (std::size_t j = 0; j < values.size(); ++j) {
      off.push_back(std::abs(values[j] - (j < split ? levels.before : levels.after)));
    }
    const double sum = std::accumulate(off.begin(), off.end(), 0.0);
    if (!(sum < least)) continue;
    least = sum;
    best = levels;
    least_off = std::move(off);
  }
  constexpr double kOfMedian = 1.2533;
  const auto count = static_cast<double>(values.size());
  const auto first = static_cast<double>(best.split);
  best.sigma = kOfMedian * upper_median(least_off) / kHalfNormalMedian *
               std::sqrt(1.0 / first + 1.0 / (count - first));
  return best;
}

// The one time at which reckoned over registered lengths change, as least absolute deviations have
// it; nothing where they do not, by their spread and by 3 %.
std::optional<SetUp::Step> step_of(const CalibrationInput& input, const SetUpFit& fit) {
  constexpr std::size_t kFewest = 8;
  constexpr double kSigmas = 8.0;
  constexpr double kLeast = 0.05;
  std::vector<double> log_ratios;
  std::vector<std::size_t> moved;
  for (const SetUpFit::Motion& motion : fit.each) {
    const double length_m = input.motions[motion.index].camera.position().norm();
    if (motion.length_ratio > 0.0 && length_m > 3.0 * fit.sigma_m) {
      log_ratios.push_back(std::log(motion.length_ratio));
      moved.push_back(motion.index);
    }
  }
  if (moved.size() < 2 * kFewest) return std::nullopt;
  const TwoLevels levels = two_levels(log_ratios, kFewest);
  const Estimated log_factor{levels.before - levels.after, levels.sigma};
  if (!log_factor.is_off(0.0, kSigmas, kLeast)) return std::nullopt;
  const SeenMotion& first = input.motions[moved[levels.split]];
  const double factor = std::exp(log_factor.value);
  return SetUp::Step{
      first.from_ns, {factor, factor * levels.sigma}, altitude_factor_at(input, first)};
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
  const auto found = best_reading(input, prior);
  if (!found) return std::nullopt;
  const auto fitted = fit_set_up(found->is_reversed ? reversed(input) : input.motions,
                                 OdometryTrack(input.odometry, found->format), prior);
  if (!fitted) return std::nullopt;
  const SetUpFit& fit = *fitted;
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
