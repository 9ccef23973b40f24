// What every trial of a simulated survey measures anew: dead reckoning, its holes, compass, fixes.

#include <cstdint>
#include <vector>

#include "checked_options.hpp"
#include "fathom/core/random.hpp"
#include "simulated_survey.hpp"

namespace fathom {

SimulatedSurvey SimulatedSurvey::remeasured(const OdometryOptions& odometry,
                                            std::uint64_t noise_seed, std::uint64_t trial) const {
  return remeasured(odometry, {}, noise_seed, trial);
}

SimulatedSurvey SimulatedSurvey::remeasured(const OdometryOptions& odometry,
                                            const SimulatedSensorOptions& sensors,
                                            std::uint64_t noise_seed, std::uint64_t trial) const {
  SimulatedSurvey survey = *this;
  survey.measure_motions(checked(odometry, "dataset.odometry"), noise_seed, trial);
  survey.measure_sensors(checked(sensors, "dataset"), noise_seed, trial);
  return survey;
}

void SimulatedSurvey::measure_motions(const OdometryOptions& odometry, std::uint64_t seed,
                                      std::uint64_t trial) {
  const Eigen::Matrix3d covariance = odometry.noise_covariance("dataset.odometry.");
  const double share = odometry.correlated_share;
  const MotionNoise white((1.0 - share) * covariance);
  GaussMarkovNoise correlated(share * covariance, odometry.correlation_length_m);
  has_odometry_ = odometry.source == OdometrySource::kNoisyMotion;
  RandomStream dead_reckoning(seed, "dead_reckoning", trial);
  RandomStream correlated_part(seed, "correlated_dead_reckoning", trial);
  for (std::size_t i = 0; i < infos_.size(); ++i) {
    FrameInfo& info = infos_[i];
    info.motion.reset();
    info.is_hole = false;
    if (!has_odometry_ || i == 0) continue;
    const Pose motion = between(*infos_[i - 1].ground_truth, *info.ground_truth);
    Eigen::Vector3d noisy = white.disturb(motion, dead_reckoning).vector();
    if (share > 0.0) noisy += correlated.draw(motion.position().norm(), correlated_part);
    info.motion = UncertainPose{Pose{noisy.x(), noisy.y(), wrap_angle(noisy.z())}, covariance};
  }
}

void SimulatedSurvey::measure_sensors(const SimulatedSensorOptions& sensors, std::uint64_t seed,
                                      std::uint64_t trial) {
  std::vector<StampedPose> way;
  std::vector<std::int64_t> times_ns;
  for (const FrameInfo& info : infos_) {
    way.push_back({info.time_ns, *info.ground_truth});
    times_ns.push_back(info.time_ns);
  }
  readings_ = draw_readings(sensors, way, seed, trial, "dataset.");
  // Visual odometry has holes of its own.
  if (!has_odometry_) return;
  const auto is_hole = draw_holes(sensors.holes, times_ns, seed, trial, "dataset.");
  const auto declared = hole_motions(is_hole, times_ns, sensors.gaps);
  for (std::size_t i = 0; i < infos_.size(); ++i) {
    if (!declared[i]) continue;
    infos_[i].motion = declared[i];
    infos_[i].is_hole = true;
  }
}

}  // namespace fathom
