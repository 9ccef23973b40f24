#pragma once

#include <string>
#include <vector>

#include "fathom/core/ignored_key.hpp"
#include "fathom/core/options.hpp"
#include "fathom/geometry/trajectory.hpp"

namespace fathom {

enum class MissionType { kSweep, kSingleLoop, kWaypoints };

/// Where the robot goes. Every mission is a polyline whose corners are rounded with one radius,
/// flown at constant speed, the heading along the path.
struct MissionOptions {
  MissionType type = MissionType::kSweep;
  int legs = 4;
  double leg_length_m = 10.0;
  double leg_spacing_m = 1.4;
  double loop_length_m = 10.0;
  double loop_width_m = 6.0;
  double loop_overrun_m = 2.0;
  std::vector<double> waypoints_m;
  double turn_radius_m = 0.5;
  double speed_m_s = 0.5;
  double frame_rate_hz = 2.0;

  void describe(OptionTable& table);
  /// Keys that the type has no use for.
  std::vector<IgnoredKey> ignored_keys() const;
};

/// The true poses of all frames, frame i at i / frame_rate_hz; world: the pose of frame 0, so the
/// first is the identity. `options` are within their described bounds.
///
/// A sweep is a lawn mower that works to port. A single loop is a rectangle flown to port from the
/// middle of its first side, and on past the start. Throws InputError naming `key_prefix` + the key
/// where corners do not fit between their neighbours or the mission would have too many frames.
std::vector<StampedPose> fly_mission(const MissionOptions& options, const std::string& key_prefix);

}  // namespace fathom
