#pragma once

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "fathom/core/random.hpp"
#include "fathom/estimation/relative_estimator.hpp"
#include "fathom/estimators/builtin.hpp"
#include "fathom/geometry/covariance.hpp"
#include "fathom/measurements/measurement_log.hpp"

namespace fathom::test {

/// A full, non-diagonal covariance of (x, y, θ).
inline Eigen::Matrix3d full_covariance(double sigma_m, double sigma_rad) {
  const double c = 0.5 * sigma_m * sigma_rad;
  Eigen::Matrix3d C;
  C << sigma_m * sigma_m, 0.3 * sigma_m * sigma_m, c,              //
      0.3 * sigma_m * sigma_m, 2.0 * sigma_m * sigma_m, -0.6 * c,  //
      c, -0.6 * c, sigma_rad * sigma_rad;
  return C;
}

inline Pose perturbed(const Pose& motion, double sigma_m, double sigma_rad, RandomStream& random) {
  return {motion.x + sigma_m * random.normal(), motion.y + sigma_m * random.normal(),
          wrap_angle(motion.theta + sigma_rad * random.normal())};
}

struct LogOptions {
  std::size_t keyframes = 40;
  double noise = 1.0;          ///< times the sigmas below
  std::size_t loop_every = 5;  ///< keyframes between two that close loops; 0: none
  bool loops_at_end_only = false;
  Pose origin{};
  std::uint64_t seed = 1;
};

inline constexpr double kStepSigmaM = 0.03;
inline constexpr double kStepSigmaRad = 0.02;
inline constexpr double kLoopSigmaM = 0.01;
inline constexpr double kLoopSigmaRad = 0.005;

/// True poses of two rounds of a circle; the heading passes ±π twice.
inline std::vector<Pose> circle(std::size_t keyframes, const Pose& origin = {}) {
  std::vector<Pose> poses{origin};
  const double turn = 4.0 * M_PI / static_cast<double>(keyframes);
  for (std::size_t k = 1; k < keyframes; ++k) {
    poses.push_back(compose(poses.back(), Pose{1.0, 0.1, turn}));
  }
  return poses;
}

/// A noisy log of the circle. Loops go one round back, and to both neighbours there: three at once.
inline MeasurementLog circle_log(const LogOptions& options) {
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
    if (!due) continue;
    const std::size_t round = options.keyframes / 2;
    for (const std::size_t back : {round + 1, round, round - 1}) {
      if (back > k) continue;
      const std::size_t from = k - back;
      log.add_registration(RelativePose::from_covariance(
          from, k,
          perturbed(between(truth[from], truth[k]), options.noise * kLoopSigmaM,
                    options.noise * kLoopSigmaRad, random),
          full_covariance(kLoopSigmaM, kLoopSigmaRad)));
    }
  }
  return log;
}

/// The circle with little noise, and a true loop from a keyframe to keyframe 27 that is as precise
/// as asked for.
inline MeasurementLog with_precise_loop(std::size_t from, double information) {
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

/// The circle with loops one round back, and from its last keyframes five more that take them for
/// the place of keyframe 4 and its neighbours: they agree with one another and are all wrong.
inline MeasurementLog with_a_false_place(std::size_t keyframes) {
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

inline EstimatorValues values(const std::vector<std::pair<std::string, std::string>>& settings) {
  EstimatorValues result;
  for (const auto& [key, value] : settings) result[key] = OptionValue::scalar(value);
  return result;
}

/// What is measured of a keyframe.
inline UpdateReport give(Estimator& estimator, const KeyframeMeasurements& arrival) {
  return estimator.update({arrival.registrations, arrival.absolute});
}
inline UpdateReport give(RelativeEstimator& estimator, const KeyframeMeasurements& arrival) {
  return estimator.close_loops(arrival.registrations);
}

/// Gives a whole log to an estimator; the worst outcome.
template <class AnyEstimator>
Outcome feed(AnyEstimator& estimator, const MeasurementLog& log,
             std::vector<LoopDecision>* decisions = nullptr) {
  Outcome outcome = Outcome::converged;
  for (std::size_t k = 0; k < log.size(); ++k) {
    if (k > 0) estimator.add_keyframe(log.arrival(k).step);
    if (log.arrival(k).registrations.empty() && log.arrival(k).absolute.empty()) continue;
    const UpdateReport report = give(estimator, log.arrival(k));
    outcome = worse(outcome, report.outcome);
    if (decisions != nullptr) {
      decisions->insert(decisions->end(), report.loops.begin(), report.loops.end());
    }
  }
  return worse(outcome, estimator.finish().outcome);
}

inline std::unique_ptr<Estimator> solved(const std::string& type, const MeasurementLog& log,
                                         const EstimatorValues& options = {}) {
  auto estimator = builtin_estimators().find(type).create({log.start()}, options);
  feed(*estimator, log);
  return estimator;
}

/// Largest distance between poses of the same keyframe, m, and likewise of headings, rad.
inline double largest_distance(std::span<const Pose> a, std::span<const Pose> b) {
  double largest = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    largest = std::max(largest, (a[k].position() - b[k].position()).norm());
  }
  return largest;
}

inline double largest_turn(std::span<const Pose> a, std::span<const Pose> b) {
  double largest = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    largest = std::max(largest, std::abs(wrap_angle(a[k].theta - b[k].theta)));
  }
  return largest;
}

}  // namespace fathom::test
