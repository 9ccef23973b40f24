#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "fathom/core/options.hpp"

namespace fathom {

/// How a camera is tilted about its own centre, radians; right-handed about the axes of the body
/// (docs/conventions.md): positive roll looks to port, positive pitch looks aft. Pitch is applied
/// after roll: R = Rot_y(pitch) Rot_x(roll).
struct Tilt {
  double roll_rad = 0.0;
  double pitch_rad = 0.0;

  bool is_level() const { return roll_rad == 0.0 && pitch_rad == 0.0; }

  Eigen::Matrix3d rotation() const;

  bool operator==(const Tilt&) const = default;
};

/// Roll and pitch of a simulated body: each a stationary first-order Gauss-Markov process
/// (Gelb 1974) of its own random stream.
struct AttitudeOptions {
  double roll_sigma_rad = 0.0;
  double pitch_sigma_rad = 0.0;
  std::optional<double> both_sigma_rad;  ///< in place of the two; to be swept as one
  double correlation_time_s = 2.0;       ///< after which a correlation of 1/e is left; 0: none

  void describe(OptionTable& table);

  /// Those in force, rad.
  double roll_sigma() const { return both_sigma_rad.value_or(roll_sigma_rad); }
  double pitch_sigma() const { return both_sigma_rad.value_or(pitch_sigma_rad); }

  bool is_level() const { return roll_sigma() == 0.0 && pitch_sigma() == 0.0; }

  /// Throws InputError naming `prefix` + the key: a correlation time without a sigma, or
  /// a sigma of both beside one of either.
  void check(const std::string& prefix) const;
};

/// One tilt per frame, `period_s` apart; of the seed alone, so the same in all trials.
std::vector<Tilt> draw_attitude(const AttitudeOptions& options, std::size_t frames, double period_s,
                                std::uint64_t seed);

}  // namespace fathom
