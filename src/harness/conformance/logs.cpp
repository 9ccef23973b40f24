#include "logs.hpp"

#include <algorithm>
#include <optional>

#include "fathom/geometry/covariance.hpp"

namespace fathom::conformance {
namespace {

// Loops one round back, and to both neighbours there.
void add_loops(MeasurementLog& log, const std::vector<Pose>& truth, double noise,
               RandomStream& random) {
  const std::size_t k = log.size() - 1;
  const std::size_t round = truth.size() / 2;
  for (const std::size_t back : {round + 1, round, round - 1}) {
    if (back > k) continue;
    const std::size_t from = k - back;
    log.add_registration(
        RelativePose::from_covariance(from, k,
                                      perturbed(between(truth[from], truth[k]), noise * kLoopSigmaM,
                                                noise * kLoopSigmaRad, random),
                                      full_covariance(kLoopSigmaM, kLoopSigmaRad)));
  }
}

RelativePose hole(std::size_t k, const Pose& guess) {
  const Eigen::Vector3d variances(1e4, 1e4, 10.0);
  RelativePose step = RelativePose::from_covariance(k - 1, k, guess, variances.asDiagonal());
  step.is_hole = true;
  return step;
}

}  // namespace

Eigen::Matrix3d full_covariance(double sigma_m, double sigma_rad) {
  const double c = 0.5 * sigma_m * sigma_rad;
  Eigen::Matrix3d C;
  C << sigma_m * sigma_m, 0.3 * sigma_m * sigma_m, c,              //
      0.3 * sigma_m * sigma_m, 2.0 * sigma_m * sigma_m, -0.6 * c,  //
      c, -0.6 * c, sigma_rad * sigma_rad;
  return C;
}

Pose perturbed(const Pose& motion, double sigma_m, double sigma_rad, RandomStream& random) {
  // One draw after the other: braces keep that order.
  return {motion.x + sigma_m * random.normal(), motion.y + sigma_m * random.normal(),
          wrap_angle(motion.theta + sigma_rad * random.normal())};
}

std::vector<Pose> circle(std::size_t keyframes, const Pose& origin) {
  std::vector<Pose> poses{origin};
  const double turn = 4.0 * M_PI / static_cast<double>(keyframes);
  for (std::size_t k = 1; k < keyframes; ++k) {
    poses.push_back(compose(poses.back(), Pose{1.0, 0.1, turn}));
  }
  return poses;
}

MeasurementLog circle_log(const LogOptions& options) {
  const std::vector<Pose> truth = circle(options.keyframes, options.origin);
  RandomStream random(options.seed, "log");
  MeasurementLog log(options.origin);
  for (std::size_t k = 1; k < options.keyframes; ++k) {
    log.add_keyframe(RelativePose::from_covariance(
        k - 1, k,
        perturbed(between(truth[k - 1], truth[k]), options.noise * kStepSigmaM,
                  options.noise * kStepSigmaRad, random),
        full_covariance(kStepSigmaM, kStepSigmaRad)));
    const bool due = options.loops_at_end_only
                         ? k + 1 == options.keyframes
                         : options.loop_every > 0 && k % options.loop_every == 0;
    if (due) add_loops(log, truth, options.noise, random);
  }
  return log;
}

MeasurementLog with_precise_loop(std::size_t from, double information) {
  LogOptions options;
  options.noise = 0.1;
  const MeasurementLog plain = circle_log(options);
  const std::vector<Pose> truth = circle(options.keyframes);
  MeasurementLog log;
  for (std::size_t k = 1; k < plain.size(); ++k) {
    log.add_keyframe(plain.arrival(k).step);
    for (const RelativePose& z : plain.arrival(k).registrations) log.add_registration(z);
    if (k != 27) continue;
    log.add_registration({from, k, between(truth[from], truth[k]),
                          information * Eigen::Matrix3d::Identity(), std::nullopt});
  }
  return log;
}

MeasurementLog with_a_false_place(std::size_t keyframes) {
  LogOptions options;
  options.keyframes = keyframes;
  const MeasurementLog right = circle_log(options);
  const std::vector<Pose> truth = circle(keyframes);
  MeasurementLog log;
  for (std::size_t k = 1; k < keyframes; ++k) {
    log.add_keyframe(right.arrival(k).step);
    for (const RelativePose& z : right.arrival(k).registrations) log.add_registration(z);
    if (k + 5 < keyframes) continue;
    const std::size_t from = k + 9 - keyframes;
    const Pose wrong = between(truth[from + keyframes / 4], truth[k]);
    log.add_registration(
        RelativePose::from_covariance(from, k, wrong, full_covariance(kLoopSigmaM, kLoopSigmaRad)));
  }
  return log;
}

MeasurementLog rewritten(const MeasurementLog& log,
                         const std::function<bool(std::size_t index)>& turns) {
  MeasurementLog result(log.origin());
  std::size_t index = 0;
  for (std::size_t k = 1; k < log.size(); ++k) {
    result.add_keyframe(log.arrival(k).step);
    for (const RelativePose& z : log.arrival(k).registrations) {
      result.add_registration(turns(index++) ? z.reversed() : z);
    }
  }
  return result;
}

MeasurementLog with_holes(const MeasurementLog& log, const std::vector<std::size_t>& at,
                          const Pose& guess) {
  MeasurementLog result(log.start());
  for (std::size_t k = 0; k < log.size(); ++k) {
    const bool is_hole = std::find(at.begin(), at.end(), k) != at.end();
    if (k > 0) result.add_keyframe(is_hole ? hole(k, guess) : log.arrival(k).step);
    for (const RelativePose& z : log.arrival(k).registrations) result.add_registration(z);
    for (const AbsolutePose& z : log.arrival(k).absolute) result.add_absolute(z);
  }
  return result;
}

MeasurementLog moved(const MeasurementLog& log, const Pose& world) {
  StartPose start = log.start();
  start.pose = compose(world, start.pose);
  start.covariance = transport(planar_rotation(world.theta), start.covariance);
  MeasurementLog result(start);
  for (std::size_t k = 0; k < log.size(); ++k) {
    if (k > 0) result.add_keyframe(log.arrival(k).step);
    for (const RelativePose& z : log.arrival(k).registrations) result.add_registration(z);
    for (AbsolutePose z : log.arrival(k).absolute) {
      z.pose = compose(world, z.pose);
      result.add_absolute(z);
    }
  }
  return result;
}

double largest_distance(std::span<const Pose> a, std::span<const Pose> b) {
  double largest = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    largest = std::max(largest, (a[k].position() - b[k].position()).norm());
  }
  return largest;
}

double largest_turn(std::span<const Pose> a, std::span<const Pose> b) {
  double largest = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    largest = std::max(largest, std::abs(wrap_angle(a[k].theta - b[k].theta)));
  }
  return largest;
}

}  // namespace fathom::conformance
