#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fathom/core/options.hpp"
#include "fathom/datasets/mission.hpp"
#include "fathom/datasets/motion_noise.hpp"
#include "fathom/datasets/simulated_sensors.hpp"
#include "fathom/datasets/start_options.hpp"
#include "fathom/geometry/trajectory.hpp"
#include "fathom/measurements/measurement_log.hpp"

namespace fathom {

/// Registrations as they are drawn, and what real ones do that their covariance does not say: the
/// estimators are told the covariance of `noise` alone.
struct SimulatedLoopOptions {
  double max_distance_m = 1.5;  ///< true distance of two keyframes, below which a pair is tried
  double probability = 0.9;  ///< of success at distance 0, falling in a line to 0 at the farthest
  std::optional<int> max_per_keyframe;  ///< the nearest of the found
  DrawnNoiseOptions noise{"of a registration", 0.005, 0.005, 0.003};
  double shared_sigma_m = 0.0;  ///< error of each keyframe's picture, in all its registrations
  double shared_sigma_rad = 0.0;
  /// Whether the estimators are told of it (RelativePose::shared).
  bool shared_is_told = false;
  double scale_error = 0.0;  ///< share by which measured distances are too long
  double tail_share = 0.0;   ///< of registrations whose error is larger than their covariance says
  double tail_factor = 10.0;

  void describe(OptionTable& table);
};

struct SimulatedLogOptions {
  MissionOptions mission;
  int separation_frames = 5;  ///< frames from one keyframe to the next
  DrawnNoiseOptions odometry{"of a frame's motion"};
  SimulatedLoopOptions loops;
  SimulatedSensorOptions sensors;  ///< the groups compass, fixes, holes and the keys of gaps
  StartOptions start;

  void describe(OptionTable& table);
  void describe_trial(OptionTable& table);
  std::vector<IgnoredKey> ignored_keys() const;
};

/// The keyframes of a flown mission: every `separation_frames`-th frame.
struct FlownKeyframes {
  std::vector<StampedPose> frames;  ///< true poses of all frames
  std::size_t separation = 1;

  std::size_t size() const { return (frames.size() - 1) / separation + 1; }
  const StampedPose& operator[](std::size_t k) const { return frames[k * separation]; }
};

/// Measurements of a mission, drawn from the model that the estimators assume: per frame a motion
/// with Gaussian noise, composed to a step per keyframe as the front end does; per pair of near
/// keyframes, with the probability given, a registration z = ⊖X_from ⊕ X_to + ν, ν ~ N(0, R), from
/// the older to the newer one. Then what the estimators are not told, where asked for:
///
/// - shared errors: z is of the poses X ⊕ u, with one draw u a keyframe; or they are told of it;
/// - scale: the translation of z times 1 + `scale_error`;
/// - heavy tails: ν times `tail_factor` with probability `tail_share`.
///
/// Compass, fixes, holes and the start that is told (draw_readings, draw_holes, draw_start) are of
/// the frames; readings are carried to
/// keyframes (ReadingCarrier), and a step is a hole if one of its frames is in one.
///
/// Every draw is from a stream of its own (`dead_reckoning`, `loops`, `loop_noise`,
/// `shared_errors`, `tails`), the same whatever the sizes of the errors are.
MeasurementLog draw_log(const FlownKeyframes& keyframes, const SimulatedLogOptions& options,
                        std::uint64_t seed, std::uint64_t trial);

}  // namespace fathom
