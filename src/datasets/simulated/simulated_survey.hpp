#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "attitude.hpp"
#include "fathom/core/ignored_key.hpp"
#include "fathom/core/options.hpp"
#include "fathom/datasets/camera_options.hpp"
#include "fathom/datasets/frame_source.hpp"
#include "fathom/datasets/mission.hpp"
#include "fathom/datasets/motion_noise.hpp"
#include "fathom/datasets/simulated_sensors.hpp"
#include "fathom/datasets/start_options.hpp"
#include "floor_renderer.hpp"
#include "picture_effects.hpp"
#include "world.hpp"

namespace fathom {

/// Altitude over the floor: base + amplitude · sin(2π t / period), measured with noise that is
/// drawn once a survey.
struct AltitudeOptions {
  double base_m = 2.0;
  double amplitude_m = 0.0;
  double period_s = 30.0;
  double altimeter_sigma_m = 0.01;

  void describe(OptionTable& table);
};

struct SimulatedSurveyOptions {
  WorldOptions world;
  MissionOptions mission;
  AltitudeOptions altitude;
  CameraOptions camera;
  OdometryOptions odometry;
  AttitudeOptions attitude;
  PictureEffects effects;          ///< the groups `water` and `camera_effects`
  SimulatedSensorOptions sensors;  ///< the groups compass, fixes, holes and the keys of gaps
  StartOptions start;

  /// In a config these keys stand under `dataset.`.
  void describe(OptionTable& table);
  /// Of them those that only say what a trial measures: dead reckoning, compass and fixes.
  void describe_trial(OptionTable& table);
  /// Keys that the kind of mission has no use for.
  std::vector<IgnoredKey> ignored_keys() const;
  /// Over a given picture, of which nothing else is drawn.
  std::string why_surveys_are_alike() const;
};

/// A survey of a floor with noisy measurements and known ground truth. The pose of frame 0 is the
/// identity. Pictures are rendered when asked for; a procedural floor is
/// drawn when the first of them is. Copies share the floor.
class SimulatedSurvey : public FrameSource {
 public:
  /// Floor, attitude, all else in the pictures, measured altitudes, roll and pitch depend on the
  /// seed alone, dead reckoning on seed and trial; each kind of noise has its stream ("altimeter",
  /// "attitude_sensor", "dead_reckoning"). Throws InputError
  /// naming the key, with `dataset.` in front: an option out of its bounds, an altitude that
  /// reaches zero, a covariance that is not positive definite, a frame that sees beyond the world's
  /// picture.
  explicit SimulatedSurvey(const SimulatedSurveyOptions& options, std::uint64_t seed,
                           std::uint64_t trial = 0);

  /// The same survey with dead reckoning of its own, as another trial of a study has it: floor and
  /// altitudes are shared, only motions are new. They are those that the constructor would draw
  /// with this seed and trial. Throws InputError as the constructor does.
  SimulatedSurvey remeasured(const OdometryOptions& odometry, std::uint64_t noise_seed,
                             std::uint64_t trial) const;
  /// The same with holes in dead reckoning, a compass and fixes.
  SimulatedSurvey remeasured(const OdometryOptions& odometry, const SimulatedSensorOptions& sensors,
                             std::uint64_t noise_seed, std::uint64_t trial) const;

  /// Of compass and positioning system, as this trial has them.
  const AbsoluteReadings& readings() const { return readings_; }

  const Camera& camera() const override { return camera_; }
  std::size_t size() const override { return infos_.size(); }
  const FrameInfo& info(std::size_t i) const override { return infos_[i]; }
  cv::Mat image(std::size_t i) const override;
  /// Of all that determines the rendered pixels; nothing is drawn for it.
  std::uint64_t picture_id(std::size_t i) const override;

  /// False where visual odometry is to make the motions: then no frame has one.
  bool has_odometry() const override { return has_odometry_; }
  bool has_ground_truth() const override { return true; }

  /// Drawn for it, where it is not yet.
  const World& world() const;
  bool is_world_drawn() const;
  /// Of the camera over the mean plane of the floor.
  double true_altitude_m(std::size_t i) const { return views_[i].altitude_m; }
  const Tilt& true_tilt(std::size_t i) const { return views_[i].tilt; }

 private:
  class Floor;

  void fly(const SimulatedSurveyOptions& options);
  void measure_altitudes(double sigma_m, std::uint64_t seed);
  void measure_motions(const OdometryOptions& odometry, std::uint64_t seed, std::uint64_t trial);
  void measure_sensors(const SimulatedSensorOptions& sensors, std::uint64_t seed,
                       std::uint64_t trial);
  void plan_views(const SimulatedSurveyOptions& options, std::uint64_t seed);
  void plan_floor(const WorldOptions& options, std::uint64_t seed);

  Camera camera_;
  std::vector<FrameInfo> infos_;
  std::vector<View> views_;
  AbsoluteReadings readings_;
  PictureEffects effects_;
  std::shared_ptr<Floor> floor_;
  bool has_odometry_ = false;
};

}  // namespace fathom
