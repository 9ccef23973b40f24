#pragma once

#include <optional>

#include <Eigen/Core>

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

/// Roll and pitch as a sensor has them.
struct MeasuredTilt {
  Tilt tilt;
  double sigma_rad = 0.0;  ///< of the roll and of the pitch, independent of each other; >= 0

  bool operator==(const MeasuredTilt&) const = default;
};

/// How a camera stands over a flat floor: all that its place does not say. An altitude alone is
/// that of a level camera.
struct Stance {
  double altitude_m = 0.0;  ///< of the camera's centre, vertical, > 0
  Tilt tilt;

  Stance() = default;
  Stance(double altitude, const Tilt& tilted = {}) : altitude_m(altitude), tilt(tilted) {}
  Stance(double altitude, const std::optional<MeasuredTilt>& measured)
      : altitude_m(altitude), tilt(measured ? measured->tilt : Tilt{}) {}

  bool is_level() const { return tilt.is_level(); }

  bool operator==(const Stance&) const = default;
};

}  // namespace fathom
