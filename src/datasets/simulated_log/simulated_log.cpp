#include "fathom/datasets/simulated_log.hpp"

#include <algorithm>

#include "fathom/core/random.hpp"
#include "fathom/geometry/covariance.hpp"

namespace fathom {
namespace {

// Dead reckoning from one keyframe to the next.
class Steps {
 public:
  Steps(const FlownKeyframes& keyframes, const Eigen::Matrix3d& covariance, RandomStream stream)
      : keyframes_(keyframes), covariance_(covariance), noise_(covariance), stream_(stream) {}

  /// To keyframe k; to be asked for in order.
  RelativePose to(std::size_t k) {
    UncertainPose step;
    for (std::size_t i = (k - 1) * keyframes_.separation; i < k * keyframes_.separation; ++i) {
      const Pose motion = between(keyframes_.frames[i].pose, keyframes_.frames[i + 1].pose);
      step = compose(step, {noise_.disturb(motion, stream_), covariance_});
    }
    return RelativePose::from_covariance(k - 1, k, step.mean, step.covariance);
  }

 private:
  const FlownKeyframes& keyframes_;
  Eigen::Matrix3d covariance_;
  MotionNoise noise_;
  RandomStream stream_;
};

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
    return RelativePose::from_covariance(from, to, motion, covariance_);
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
  Steps steps(keyframes, options.odometry.noise_covariance("dataset.odometry."),
              RandomStream(seed, "dead_reckoning", trial));
  Registrations registrations(keyframes, options.loops,
                              options.loops.noise.noise_covariance("dataset.loops."), seed, trial);
  MeasurementLog log;
  for (std::size_t k = 1; k < keyframes.size(); ++k) {
    log.add_keyframe(steps.to(k));
    for (const RelativePose& registration : registrations.of(k)) log.add_registration(registration);
  }
  for (std::size_t k = 0; k < keyframes.size(); ++k) {
    log.ids.push_back(static_cast<std::int64_t>(k));
  }
  return log;
}

}  // namespace fathom
