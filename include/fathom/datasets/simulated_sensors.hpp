#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fathom/core/ignored_key.hpp"
#include "fathom/core/options.hpp"
#include "fathom/datasets/absolute_readings.hpp"
#include "fathom/datasets/gap_options.hpp"
#include "fathom/datasets/start_options.hpp"
#include "fathom/geometry/trajectory.hpp"

namespace fathom {

/// A simulated compass. Bias and deviation are what the estimators are not told.
struct SimulatedCompassOptions {
  std::optional<double> interval_s;  ///< absent: there is none
  double sigma_rad = 0.0175;
  double bias_rad = 0.0;
  /// Amplitude of an error that is a sine of the heading, as that of iron aboard.
  double deviation_rad = 0.0;

  void describe(OptionTable& table);
};

/// Simulated fixes of an antenna. Jumps and latency are what the estimators are not told.
struct SimulatedFixOptions {
  std::optional<double> interval_s;  ///< absent: there are none
  double sigma_m = 1.0;
  std::vector<double> covariance;  ///< [xx, xy, yy], m²; empty: from sigma_m
  double lever_x_m = 0.0;          ///< of the antenna, in the body frame
  double lever_y_m = 0.0;
  double jump_share = 0.0;  ///< of fixes that are off by jump_m
  double jump_m = 20.0;
  double latency_s = 0.0;  ///< a fix says where the antenna was so long before

  void describe(OptionTable& table);
  /// Throws InputError naming `prefix` + the key that makes it other than positive definite.
  Eigen::Matrix2d noise_covariance(const std::string& prefix) const;
};

/// Holes in simulated dead reckoning.
struct SimulatedHoleOptions {
  int count = 0;
  double length_s = 10.0;  ///< each; at least two frames

  void describe(OptionTable& table);
};

/// All that a simulated vehicle may have beside camera, altimeter and dead reckoning; none of it
/// unless asked for.
struct SimulatedSensorOptions {
  SimulatedCompassOptions compass;
  SimulatedFixOptions fixes;
  SimulatedHoleOptions holes;
  GapOptions gaps;

  /// Groups `compass`, `fixes`, `holes`, and the keys of GapOptions.
  void describe(OptionTable& table);
  std::vector<IgnoredKey> ignored_keys() const;
};

/// Readings of a vehicle on its true way, from the first frame on, each kind of noise of a stream
/// of its own: `compass` and `fixes` their σ, `compass_deviation` the heading at which the
/// deviation is zero, `fix_jumps` which fixes jump and where to. No draw depends on the size of an
/// error. Poses between frames are at constant velocity. Throws InputError with keys below
/// `prefix`.
AbsoluteReadings draw_readings(const SimulatedSensorOptions& options,
                               std::span<const StampedPose> frames, std::uint64_t seed,
                               std::uint64_t trial, const std::string& prefix);

/// Of every frame, whether its motion since the one before is in a hole: `count` holes, a frame
/// apart at least, anywhere alike; of the stream `holes`. Throws InputError with keys below
/// `prefix` where they do not fit.
std::vector<bool> draw_holes(const SimulatedHoleOptions& options,
                             std::span<const std::int64_t> times_ns, std::uint64_t seed,
                             std::uint64_t trial, const std::string& prefix);

/// The start as it is told: what is given, with a draw of its sigmas added, of the stream `start`.
/// The true start stays where it is, and all readings with it. As given where the sigmas are 0.
StartOptions draw_start(const StartOptions& given, std::uint64_t seed, std::uint64_t trial);

/// What is declared of the motion to each frame that is in a hole: its share, by time, of that of
/// its whole hole. Of the others nothing.
std::vector<std::optional<UncertainPose>> hole_motions(const std::vector<bool>& is_hole,
                                                       std::span<const std::int64_t> times_ns,
                                                       const GapOptions& gaps);

}  // namespace fathom
