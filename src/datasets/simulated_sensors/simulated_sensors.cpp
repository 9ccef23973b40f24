#include "fathom/datasets/simulated_sensors.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>

#include "fathom/core/input_error.hpp"
#include "fathom/core/random.hpp"
#include "fathom/core/text.hpp"

namespace fathom {
namespace {

constexpr double kNanoseconds = 1e9;

// The true way between frames, at constant velocity.
class TrueWay {
 public:
  explicit TrueWay(std::span<const StampedPose> frames) : frames_(frames) {}

  /// The first pose at any time before it.
  Pose at(std::int64_t time_ns) const {
    if (time_ns <= frames_.front().time_ns) return frames_.front().pose;
    const auto after =
        std::ranges::lower_bound(frames_, time_ns, std::less{}, &StampedPose::time_ns);
    if (after->time_ns == time_ns) return after->pose;
    const auto before = std::prev(after);
    const double share = static_cast<double>(time_ns - before->time_ns) /
                         static_cast<double>(after->time_ns - before->time_ns);
    const UncertainPose motion{between(before->pose, after->pose)};
    return compose(before->pose, part_of(motion, 0.0, share).mean);
  }

  /// Every so many seconds, as long as it lasts.
  std::vector<std::int64_t> times_ns(double interval_s) const {
    std::vector<std::int64_t> times;
    const std::int64_t first_ns = frames_.front().time_ns;
    const auto length_ns = static_cast<double>(frames_.back().time_ns - first_ns);
    for (double i = 0.0; std::round(i * interval_s * kNanoseconds) <= length_ns; ++i) {
      times.push_back(first_ns + std::llround(i * interval_s * kNanoseconds));
    }
    return times;
  }

 private:
  std::span<const StampedPose> frames_;
};

// So that a mistyped interval says so, and does not fill the memory.
void require_interval(double interval_s, const std::string& key) {
  constexpr double kLeast_s = 1e-3;
  if (interval_s >= kLeast_s) return;
  throw InputError(key + ": expected a number in s >= " + short_number(kLeast_s));
}

std::vector<MeasuredHeading> draw_headings(const SimulatedCompassOptions& options,
                                           const TrueWay& way, std::uint64_t seed,
                                           std::uint64_t trial) {
  RandomStream noise(seed, "compass", trial);
  RandomStream deviations(seed, "compass_deviation", trial);
  const double zero_rad = 2.0 * std::numbers::pi * deviations.uniform();
  std::vector<MeasuredHeading> headings;
  for (const std::int64_t time_ns : way.times_ns(*options.interval_s)) {
    const double true_rad = way.at(time_ns).theta;
    const double error_rad = options.bias_rad +
                             options.deviation_rad * std::sin(true_rad - zero_rad) +
                             options.sigma_rad * noise.normal();
    headings.push_back({time_ns, wrap_angle(true_rad + error_rad), options.sigma_rad});
  }
  return headings;
}

std::vector<PositionFix> draw_fixes(const SimulatedFixOptions& options,
                                    const Eigen::Matrix2d& covariance, const TrueWay& way,
                                    std::uint64_t seed, std::uint64_t trial) {
  RandomStream noise(seed, "fixes", trial);
  RandomStream jumps(seed, "fix_jumps", trial);
  const Eigen::Matrix2d L = covariance.llt().matrixL();
  const Pose antenna{options.lever_x_m, options.lever_y_m, 0.0};
  const std::int64_t latency_ns = std::llround(options.latency_s * kNanoseconds);
  std::vector<PositionFix> fixes;
  for (const std::int64_t time_ns : way.times_ns(*options.interval_s)) {
    const bool jumps_now = jumps.uniform() < options.jump_share;
    const double direction_rad = 2.0 * std::numbers::pi * jumps.uniform();
    const double x = noise.normal();
    const double y = noise.normal();
    PositionFix fix{time_ns, {}, covariance};
    fix.position_m =
        compose(way.at(time_ns - latency_ns), antenna).position() + L * Eigen::Vector2d(x, y);
    if (jumps_now) {
      fix.position_m +=
          options.jump_m * Eigen::Vector2d(std::cos(direction_rad), std::sin(direction_rad));
    }
    fixes.push_back(fix);
  }
  return fixes;
}

}  // namespace

AbsoluteReadings draw_readings(const SimulatedSensorOptions& options,
                               std::span<const StampedPose> frames, std::uint64_t seed,
                               std::uint64_t trial, const std::string& prefix) {
  AbsoluteReadings readings;
  const TrueWay way(frames);
  if (options.compass.interval_s) {
    require_interval(*options.compass.interval_s, prefix + "compass.interval_s");
    readings.headings = draw_headings(options.compass, way, seed, trial);
  }
  if (options.fixes.interval_s) {
    require_interval(*options.fixes.interval_s, prefix + "fixes.interval_s");
    readings.lever_m = {options.fixes.lever_x_m, options.fixes.lever_y_m};
    const Eigen::Matrix2d covariance = options.fixes.noise_covariance(prefix + "fixes.");
    readings.has_jumps = options.fixes.jump_share > 0.0;
    readings.fixes = draw_fixes(options.fixes, covariance, way, seed, trial);
  }
  return readings;
}

std::vector<bool> draw_holes(const SimulatedHoleOptions& options,
                             std::span<const std::int64_t> times_ns, std::uint64_t seed,
                             std::uint64_t trial, const std::string& prefix) {
  std::vector<bool> is_hole(times_ns.size(), false);
  if (options.count == 0) return is_hole;
  const std::size_t motions = times_ns.size() - 1;
  const double survey_s = static_cast<double>(times_ns.back() - times_ns.front()) / kNanoseconds;
  const double frame_s = survey_s / static_cast<double>(motions);
  const auto count = static_cast<std::size_t>(options.count);
  const double frames_each = std::max(2.0, std::round(options.length_s / frame_s));
  if (!(static_cast<double>(count) * (frames_each + 1.0) <= static_cast<double>(motions) + 1.0)) {
    throw InputError(prefix + "holes.length_s: " + std::to_string(count) + " of " +
                     short_number(options.length_s) + " s do not fit into a survey of " +
                     short_number(survey_s) + " s; expected shorter or fewer ones");
  }
  const auto length = static_cast<std::size_t>(frames_each);
  // The frames that are left over are dealt out before, between and behind the holes.
  const std::size_t left = motions + 1 - count * (length + 1);
  RandomStream stream(seed, "holes", trial);
  std::vector<std::size_t> before;
  for (std::size_t hole = 0; hole < count; ++hole) {
    before.push_back(static_cast<std::size_t>(stream.index(left + 1)));
  }
  std::ranges::sort(before);
  for (std::size_t hole = 0; hole < count; ++hole) {
    const std::size_t first = 1 + before[hole] + hole * (length + 1);
    std::fill_n(is_hole.begin() + static_cast<std::ptrdiff_t>(first), length, true);
  }
  return is_hole;
}

StartOptions draw_start(const StartOptions& given, std::uint64_t seed, std::uint64_t trial) {
  RandomStream noise(seed, "start", trial);
  const double x = noise.normal();
  const double y = noise.normal();
  const double theta = noise.normal();
  StartOptions told = given;
  if (given.sigma_m > 0.0) {
    if (given.x_m) *told.x_m += given.sigma_m * x;
    if (given.y_m) *told.y_m += given.sigma_m * y;
  }
  if (given.sigma_rad > 0.0 && given.heading_rad) {
    told.heading_rad = wrap_angle(*given.heading_rad + given.sigma_rad * theta);
  }
  return told;
}

std::vector<std::optional<UncertainPose>> hole_motions(const std::vector<bool>& is_hole,
                                                       std::span<const std::int64_t> times_ns,
                                                       const GapOptions& gaps) {
  std::vector<std::optional<UncertainPose>> motions(is_hole.size());
  for (std::size_t i = 1; i < is_hole.size(); ++i) {
    if (!is_hole[i] || is_hole[i - 1]) continue;
    std::size_t last = i;
    while (last + 1 < is_hole.size() && is_hole[last + 1]) ++last;
    const auto since_ns = [&](std::size_t frame) {
      return static_cast<double>(times_ns[frame] - times_ns[i - 1]);
    };
    const double whole_ns = since_ns(last);
    const UncertainPose whole = gaps.motion(whole_ns / kNanoseconds);
    for (std::size_t frame = i; frame <= last; ++frame) {
      motions[frame] = part_of(whole, since_ns(frame - 1) / whole_ns, since_ns(frame) / whole_ns);
    }
  }
  return motions;
}

}  // namespace fathom
