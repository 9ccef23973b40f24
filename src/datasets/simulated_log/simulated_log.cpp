#include "simulated_log.hpp"

#include <algorithm>
#include <memory>

#include "fathom/core/random.hpp"
#include "fathom/datasets/reading_carrier.hpp"
#include "fathom/geometry/covariance.hpp"

namespace fathom {
namespace {

std::vector<std::int64_t> times_of(const FlownKeyframes& keyframes) {
  std::vector<std::int64_t> times_ns;
  for (const StampedPose& frame : keyframes.frames) times_ns.push_back(frame.time_ns);
  return times_ns;
}

// Frame by frame; over holes as declared.
std::vector<DeadReckonedFrame> dead_reckoned(const FlownKeyframes& keyframes,
                                             const SimulatedLogOptions& options, std::uint64_t seed,
                                             std::uint64_t trial) {
  const Eigen::Matrix3d covariance = options.odometry.noise_covariance("dataset.odometry.");
  const MotionNoise noise(covariance);
  RandomStream stream(seed, "dead_reckoning", trial);
  const std::vector<std::int64_t> times_ns = times_of(keyframes);
  const std::vector<bool> is_hole =
      draw_holes(options.sensors.holes, times_ns, seed, trial, "dataset.");
  const auto declared = hole_motions(is_hole, times_ns, options.sensors.gaps);
  std::vector<DeadReckonedFrame> frames{{times_ns[0], {}, false}};
  for (std::size_t i = 1; i < times_ns.size(); ++i) {
    const Pose motion = between(keyframes.frames[i - 1].pose, keyframes.frames[i].pose);
    const UncertainPose measured{noise.disturb(motion, stream), covariance};
    frames.push_back({times_ns[i], declared[i].value_or(measured), is_hole[i]});
  }
  return frames;
}

// From keyframe k − 1 to keyframe k.
RelativePose step_to(std::size_t k, const std::vector<DeadReckonedFrame>& frames,
                     std::size_t separation) {
  UncertainPose motion;
  bool is_hole = false;
  for (std::size_t i = (k - 1) * separation + 1; i <= k * separation; ++i) {
    motion = compose(motion, frames[i].motion);
    is_hole = is_hole || frames[i].is_hole;
  }
  RelativePose step = RelativePose::from_covariance(k - 1, k, motion.mean, motion.covariance);
  step.is_hole = is_hole;
  return step;
}

struct Found {
  double distance_m = 0.0;
  RelativePose registration;
};

class Registrations {
 public:
  Registrations(const FlownKeyframes& keyframes, const SimulatedLoopOptions& options,
                const Eigen::Matrix3d& covariance, std::uint64_t seed, std::uint64_t trial)
      : keyframes_(keyframes),
        options_(options),
        covariance_(covariance),
        noise_(covariance),
        success_(seed, "loops", trial),
        errors_(seed, "loop_noise", trial),
        tails_(seed, "tails", trial) {
    RandomStream shared(seed, "shared_errors", trial);
    for (std::size_t k = 0; k < keyframes.size(); ++k) {
      const double x = options.shared_sigma_m * shared.normal();
      const double y = options.shared_sigma_m * shared.normal();
      const double theta = options.shared_sigma_rad * shared.normal();
      seen_from_.push_back(compose(keyframes[k].pose, {x, y, theta}));
    }
  }

  /// Of the newest keyframe with all earlier ones, in the order of these; to be asked for in order.
  std::vector<RelativePose> of(std::size_t newest) {
    std::vector<Found> found;
    for (std::size_t k = 0; k < newest; ++k) {
      const double distance_m =
          (keyframes_[newest].pose.position() - keyframes_[k].pose.position()).norm();
      if (!(distance_m < options_.max_distance_m)) continue;
      const double chance = options_.probability * (1.0 - distance_m / options_.max_distance_m);
      const RelativePose registration = draw(k, newest);
      if (success_.uniform() < chance) found.push_back({distance_m, registration});
    }
    return nearest(std::move(found));
  }

 private:
  RelativePose draw(std::size_t from, std::size_t to) {
    Pose motion = between(seen_from_[from], seen_from_[to]);
    motion.x *= 1.0 + options_.scale_error;
    motion.y *= 1.0 + options_.scale_error;
    const bool is_in_tail = tails_.uniform() < options_.tail_share;
    const Eigen::Vector3d error = (is_in_tail ? options_.tail_factor : 1.0) * noise_.draw(errors_);
    motion = {motion.x + error.x(), motion.y + error.y(), wrap_angle(motion.theta + error.z())};
    const bool is_told = options_.shared_is_told &&
                         (options_.shared_sigma_m > 0.0 || options_.shared_sigma_rad > 0.0);
    if (!is_told) {
      return RelativePose::from_covariance(from, to, motion, covariance_);
    }
    const SharedErrors shared = told(motion);
    RelativePose z = RelativePose::from_covariance(from, to, motion, shared.total());
    z.shared = std::make_shared<const SharedErrors>(shared);
    return z;
  }

  // Of z = ⊖u_from ⊕ z₀ ⊕ u_to by both u at zero, z₀ as measured.
  SharedErrors told(const Pose& z) const {
    const Eigen::Vector3d sigma(options_.shared_sigma_m, options_.shared_sigma_m,
                                options_.shared_sigma_rad);
    SharedErrors shared{
        {-Eigen::Matrix3d::Identity(), sigma}, {planar_rotation(z.theta), sigma}, covariance_};
    shared.from.G.topRightCorner<2, 1>() << z.y, -z.x;
    return shared;
  }

  std::vector<RelativePose> nearest(std::vector<Found> found) const {
    const auto most = static_cast<std::size_t>(
        options_.max_per_keyframe.value_or(static_cast<int>(found.size())));
    if (found.size() > most) {
      std::ranges::stable_sort(found, {}, &Found::distance_m);
      found.resize(most);
      std::ranges::sort(found, {}, [](const Found& one) { return one.registration.from; });
    }
    std::vector<RelativePose> registrations;
    registrations.reserve(found.size());
    for (const Found& one : found) registrations.push_back(one.registration);
    return registrations;
  }

  const FlownKeyframes& keyframes_;
  const SimulatedLoopOptions& options_;
  Eigen::Matrix3d covariance_;
  MotionNoise noise_;
  RandomStream success_;
  RandomStream errors_;
  RandomStream tails_;
  std::vector<Pose> seen_from_;  // by keyframe: its true pose with its picture's own error
};

}  // namespace

MeasurementLog draw_log(const FlownKeyframes& keyframes, const SimulatedLogOptions& options,
                        std::uint64_t seed, std::uint64_t trial) {
  const std::vector<DeadReckonedFrame> frames = dead_reckoned(keyframes, options, seed, trial);
  const ReckonedFrames reckoning{frames.size(), [&frames](std::size_t i) { return frames[i]; }};
  const AbsoluteReadings readings =
      draw_readings(options.sensors, keyframes.frames, seed, trial, "dataset.");
  Registrations registrations(keyframes, options.loops,
                              options.loops.noise.noise_covariance("dataset.loops."), seed, trial);
  const StartOptions start = draw_start(options.start, seed, trial);
  MeasurementLog log(start_of(start, readings, reckoning));
  ReadingCarrier carrier(readings, reckoning, log.start());
  const std::size_t separation = keyframes.separation;
  for (std::size_t k = 0; k < keyframes.size(); ++k) {
    if (k > 0) {
      log.add_keyframe(step_to(k, frames, separation));
      for (const RelativePose& z : registrations.of(k)) log.add_registration(z);
    }
    const bool is_last = k + 1 == keyframes.size();
    const auto next = is_last ? std::nullopt : std::optional((k + 1) * separation);
    for (const AbsolutePose& z : carrier.of(k, k * separation, next)) log.add_absolute(z);
  }
  for (std::size_t k = 0; k < keyframes.size(); ++k) {
    log.ids.push_back(static_cast<std::int64_t>(k));
  }
  return log;
}

}  // namespace fathom
