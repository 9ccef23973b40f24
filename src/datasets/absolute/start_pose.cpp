#include <algorithm>
#include <cmath>
#include <numbers>

#include "fathom/core/input_error.hpp"
#include "fathom/datasets/reading_carrier.hpp"

namespace fathom {
namespace {

constexpr std::size_t kFirstReadings = 10;
// χ² of one and of two degrees of freedom, of right readings 99 %.
constexpr double kHeadingsAgree = 6.63;
constexpr double kFixesAgree = 9.21;

/// A reading with the motion from frame 0 to it.
template <class Reading>
struct Reached {
  Reading reading;
  UncertainPose motion;
};

// The first readings that are not before frame 0, at most so many; none after the last frame, and
// of those behind a hole only one, if it is the first.
template <class Reading>
std::vector<Reached<Reading>> first_readings(const std::vector<Reading>& readings,
                                             const DeadReckoning& frames) {
  std::vector<Reached<Reading>> first;
  if (frames.size == 0) return first;
  std::int64_t before_ns = frames.frame(0).time_ns;
  auto next = std::ranges::find_if(
      readings, [&](const Reading& reading) { return reading.time_ns >= before_ns; });
  UncertainPose motion;
  bool is_behind_hole = false;
  for (std::size_t i = 1; next != readings.end() && first.size() < kFirstReadings; ++i) {
    for (; next != readings.end() && next->time_ns == before_ns && first.size() < kFirstReadings;
         ++next) {
      first.push_back({*next, motion});
    }
    if (i >= frames.size || next == readings.end()) break;
    const DeadReckonedFrame after = frames.frame(i);
    is_behind_hole = is_behind_hole || after.is_hole;
    if (is_behind_hole && !first.empty()) break;
    for (; next != readings.end() && next->time_ns < after.time_ns && first.size() < kFirstReadings;
         ++next) {
      const double share = static_cast<double>(next->time_ns - before_ns) /
                           static_cast<double>(after.time_ns - before_ns);
      first.push_back({*next, compose(motion, part_of(after.motion, 0.0, share))});
      if (is_behind_hole) return first;
    }
    motion = compose(motion, after.motion);
    before_ns = after.time_ns;
  }
  return first;
}

/// The reading with which most of the first ones agree, and whether two others do.
struct Agreed {
  std::size_t index = 0;
  bool is_sure = false;
};

template <class Agree>
Agreed most_agreed(std::size_t count, Agree agree) {
  Agreed best;
  std::size_t most = 0;
  for (std::size_t i = 0; i < count; ++i) {
    std::size_t agreeing = 0;
    for (std::size_t j = 0; j < count; ++j) agreeing += i == j || agree(i, j) ? 1 : 0;
    if (agreeing <= most) continue;
    most = agreeing;
    best = {i, agreeing >= 3};
  }
  return best;
}

double width(const Agreed& agreed) {
  return agreed.is_sure ? kAgreedStartWidth : kStartWidth;
}

struct Known {
  double value = 0.0;
  double sigma = 0.0;
};

Known heading_of(const StartOptions& options, const AbsoluteReadings& readings,
                 const DeadReckoning& frames) {
  if (options.heading_rad) return {wrap_angle(*options.heading_rad), options.sigma_rad};
  const auto first = first_readings(readings.headings, frames);
  if (first.empty()) {
    if (readings.fixes.empty()) return {};
    throw InputError(
        "dataset.start.heading_rad: is missing: fixes alone do not say the heading of the first "
        "frame; expected it with dataset.start.sigma_rad, or headings of a compass");
  }
  std::vector<Known> at_start;
  for (const auto& [reading, motion] : first) {
    const AbsolutePose z = heading_after(0, reading.heading_rad, reading.sigma_rad, motion);
    at_start.push_back({z.pose.theta, 1.0 / std::sqrt(z.information(2, 2))});
  }
  const Agreed agreed = most_agreed(at_start.size(), [&](std::size_t i, std::size_t j) {
    const double apart = wrap_angle(at_start[i].value - at_start[j].value);
    const double variance =
        at_start[i].sigma * at_start[i].sigma + at_start[j].sigma * at_start[j].sigma;
    return apart * apart <= kHeadingsAgree * variance;
  });
  const Known& best = at_start[agreed.index];
  return {best.value, std::min(width(agreed) * best.sigma, std::numbers::pi)};
}

struct KnownPosition {
  Eigen::Vector2d value = Eigen::Vector2d::Zero();
  double sigma_m = 0.0;
};

KnownPosition position_of(const StartOptions& options, const AbsoluteReadings& readings,
                          const DeadReckoning& frames, const Known& heading) {
  if (options.has_position()) return {{*options.x_m, *options.y_m}, options.sigma_m};
  const auto first = first_readings(readings.fixes, frames);
  if (first.empty()) return {};
  std::vector<Eigen::Vector2d> at_start;
  std::vector<double> variances;
  for (const auto& [fix, motion] : first) {
    const AbsolutePose z =
        fix_of_point(0, fix.position_m, fix.covariance, motion, readings.lever_m, heading.value);
    at_start.push_back(z.pose.position());
    variances.push_back(0.5 *
                        (fix.covariance.trace() + motion.covariance.topLeftCorner<2, 2>().trace()));
  }
  const Agreed agreed = most_agreed(at_start.size(), [&](std::size_t i, std::size_t j) {
    // What is not known of the heading turns the way between them.
    const Eigen::Vector2d way = first[i].motion.mean.position() - first[j].motion.mean.position();
    const double turned = heading.sigma * heading.sigma * way.squaredNorm();
    const double apart = (at_start[i] - at_start[j]).squaredNorm();
    return apart <= kFixesAgree * (variances[i] + variances[j] + turned);
  });
  return {at_start[agreed.index], width(agreed) * std::sqrt(variances[agreed.index])};
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
