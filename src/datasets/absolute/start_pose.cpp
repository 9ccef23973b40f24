#include <algorithm>
#include <cmath>
#include <numbers>

#include "fathom/core/input_error.hpp"
#include "fathom/datasets/reading_carrier.hpp"

namespace fathom {
namespace {

// From frame 0 to a time; nothing after the last frame.
std::optional<UncertainPose> motion_until(const DeadReckoning& frames, std::int64_t time_ns) {
  UncertainPose motion;
  std::int64_t before_ns = frames.frame(0).time_ns;
  for (std::size_t i = 1; i < frames.size && before_ns < time_ns; ++i) {
    const DeadReckonedFrame after = frames.frame(i);
    const double share =
        static_cast<double>(time_ns - before_ns) / static_cast<double>(after.time_ns - before_ns);
    motion = compose(motion, part_of(after.motion, 0.0, std::min(share, 1.0)));
    before_ns = after.time_ns;
  }
  if (before_ns < time_ns) return std::nullopt;
  return motion;
}

// The first reading that is not before frame 0, with the motion to it.
template <class Reading>
std::optional<std::pair<Reading, UncertainPose>> first_of(const std::vector<Reading>& readings,
                                                          const DeadReckoning& frames) {
  if (frames.size == 0 || readings.empty()) return std::nullopt;
  const std::int64_t start_ns = frames.frame(0).time_ns;
  const auto first = std::ranges::find_if(
      readings, [&](const Reading& reading) { return reading.time_ns >= start_ns; });
  if (first == readings.end()) return std::nullopt;
  const auto motion = motion_until(frames, first->time_ns);
  if (!motion) return std::nullopt;
  return std::pair{*first, *motion};
}

struct Known {
  double value = 0.0;
  double sigma = 0.0;
};

Known heading_of(const StartOptions& options, const AbsoluteReadings& readings,
                 const DeadReckoning& frames) {
  if (options.heading_rad) return {wrap_angle(*options.heading_rad), options.sigma_rad};
  if (const auto first = first_of(readings.headings, frames)) {
    const AbsolutePose at_start =
        heading_after(0, first->first.heading_rad, first->first.sigma_rad, first->second);
    return {at_start.pose.theta,
            std::min(kStartWidth / std::sqrt(at_start.information(2, 2)), std::numbers::pi)};
  }
  if (readings.fixes.empty()) return {};
  throw InputError(
      "dataset.start.heading_rad: is missing: fixes alone do not say the heading of the first "
      "frame; expected it with dataset.start.sigma_rad, or headings of a compass");
}

struct KnownPosition {
  Eigen::Vector2d value = Eigen::Vector2d::Zero();
  double sigma_m = 0.0;
};

KnownPosition position_of(const StartOptions& options, const AbsoluteReadings& readings,
                          const DeadReckoning& frames, const Known& heading) {
  if (options.has_position()) return {{*options.x_m, *options.y_m}, options.sigma_m};
  const auto first = first_of(readings.fixes, frames);
  if (!first) return {};
  const auto& [fix, motion] = *first;
  const AbsolutePose at_start =
      fix_of_point(0, fix.position_m, fix.covariance, motion, readings.lever_m, heading.value);
  const double sigma_m =
      std::sqrt(fix.covariance.trace() + motion.covariance.topLeftCorner<2, 2>().trace());
  return {at_start.pose.position(), kStartWidth * sigma_m};
}

}  // namespace

StartPose start_of(const StartOptions& options, const AbsoluteReadings& readings,
                   const DeadReckoning& frames) {
  options.check("dataset.start.");
  const Known heading = heading_of(options, readings, frames);
  const KnownPosition position = position_of(options, readings, frames, heading);
  StartPose start({position.value.x(), position.value.y(), heading.value});
  if (heading.sigma == 0.0 && position.sigma_m == 0.0) return start;
  const double sigma_m = position.sigma_m > 0.0 ? position.sigma_m : kHeldSigma_m;
  const double sigma_rad = heading.sigma > 0.0 ? heading.sigma : kHeldSigma_rad;
  start.covariance =
      Eigen::Vector3d(sigma_m * sigma_m, sigma_m * sigma_m, sigma_rad * sigma_rad).asDiagonal();
  return start;
}

DeadReckoning dead_reckoning_of(const FrameSource& frames) {
  return {
      frames.size(), [&frames](std::size_t i) {
        const FrameInfo& info = frames.info(i);
        return DeadReckonedFrame{info.time_ns, info.motion.value_or(UncertainPose{}), info.is_hole};
      }};
}

}  // namespace fathom
