#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fathom/core/options.hpp"
#include "fathom/vision/camera.hpp"

namespace fathom {

/// Roll and pitch of a simulated body, each a stationary first-order Gauss-Markov process
/// (Gelb 1974) of its own random stream; and what a sensor has of them.
struct AttitudeOptions {
  double roll_sigma_rad = 0.0;
  double pitch_sigma_rad = 0.0;
  std::optional<double> both_sigma_rad;  ///< in place of the two; to be swept as one
  double correlation_time_s = 2.0;       ///< after which a correlation of 1/e is left; 0: none

  /// Of the noise of measured roll and pitch, white; the sensor states it. Absent: not measured.
  std::optional<double> measured_sigma_rad;
  double roll_mounting_error_rad = 0.0;  ///< constant, of measured roll; the sensor knows nothing
  double pitch_mounting_error_rad = 0.0;

  void describe(OptionTable& table);

  /// Those in force, rad.
  double roll_sigma() const { return both_sigma_rad.value_or(roll_sigma_rad); }
  double pitch_sigma() const { return both_sigma_rad.value_or(pitch_sigma_rad); }

  bool is_level() const { return roll_sigma() == 0.0 && pitch_sigma() == 0.0; }

  /// Throws InputError naming `prefix` + the key: a correlation time without a sigma, a sigma of
  /// both beside one of either, or a mounting error of what is not measured.
  void check(const std::string& prefix) const;
};

/// One tilt per frame, `period_s` apart; of the seed alone, so the same in all trials.
std::vector<Tilt> draw_attitude(const AttitudeOptions& options, std::size_t frames, double period_s,
                                std::uint64_t seed);

/// Those tilts as measured: the mounting error added, and noise; of the seed alone. Empty where
/// they are not measured.
std::vector<MeasuredTilt> measure_attitude(const AttitudeOptions& options,
                                           const std::vector<Tilt>& tilts, std::uint64_t seed);

}  // namespace fathom
