#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "fathom/core/random.hpp"
#include "fathom/measurements/measurement_log.hpp"

/// Logs of known truth, and what is compared of an estimate with it.
namespace fathom::conformance {

/// A full, non-diagonal covariance of (x, y, θ).
Eigen::Matrix3d full_covariance(double sigma_m, double sigma_rad);

/// A motion with noise on it.
Pose perturbed(const Pose& motion, double sigma_m, double sigma_rad, RandomStream& random);

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
std::vector<Pose> circle(std::size_t keyframes, const Pose& origin = {});

/// A noisy log of the circle. Loops go one round back, and to both neighbours there: three at once.
MeasurementLog circle_log(const LogOptions& options);

/// The circle with little noise, and a true loop from a keyframe to keyframe 27 that is as precise
/// as asked for.
MeasurementLog with_precise_loop(std::size_t from, double information);

/// The circle with loops one round back, and from its last keyframes five more that take them for
/// the place of keyframe 4 and its neighbours: they agree with one another and are all wrong.
MeasurementLog with_a_false_place(std::size_t keyframes);

/// `turns` says of each registration, in their order, whether it is written the other way round.
MeasurementLog rewritten(const MeasurementLog& log,
                         const std::function<bool(std::size_t index)>& turns);

/// The log with nothing measured at these steps, and a guess of the motion over each.
MeasurementLog with_holes(const MeasurementLog& log, const std::vector<std::size_t>& at,
                          const Pose& guess);

/// The log in a world that is turned and shifted, `world` being the old axes in the new ones.
MeasurementLog moved(const MeasurementLog& log, const Pose& world);

/// Axes as maps of UTM have them, in millions of metres.
inline constexpr Pose kFarWorld{512345.678, 5987654.321, 0.0};

/// Largest distance between poses of the same keyframe, m, and likewise of headings, rad.
double largest_distance(std::span<const Pose> a, std::span<const Pose> b);
double largest_turn(std::span<const Pose> a, std::span<const Pose> b);

}  // namespace fathom::conformance
