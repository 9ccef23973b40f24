#include "fathom/datasets/simulated_survey.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <utility>

#include "fathom/core/input_error.hpp"
#include "fathom/core/random.hpp"
#include "fathom/core/text.hpp"
#include "fathom/datasets/mission.hpp"

namespace fathom {
namespace {

const std::string kPrefix = "dataset.";

// Options that code filled in keep the same bounds as those of a config: each is set to itself.
// Lists have no bounds of their own; those who use them check them.
SimulatedSurveyOptions checked(SimulatedSurveyOptions options) {
  OptionTable table;
  table.group("dataset", options);
  for (const OptionDescription& option : table.descriptions()) {
    if (option.type == "list of real") continue;
    table.set(option.key, OptionValue::scalar(table.value(option.key)));
  }
  return options;
}

Camera camera_of(const CameraOptions& options) {
  try {
    return Camera(options.model(kPrefix + "camera."));
  } catch (const InputError& error) {
    const std::string what = error.what();
    if (what.starts_with(kPrefix)) throw;
    throw InputError(kPrefix + "camera: " + what);
  }
}

std::vector<double> true_altitudes(const AltitudeOptions& options,
                                   const std::vector<StampedPose>& poses) {
  if (options.amplitude_m >= options.base_m) {
    throw InputError(kPrefix + "altitude.amplitude_m: lets the altitude fall to zero; expected a " +
                     "number in m below " + kPrefix + "altitude.base_m");
  }
  std::vector<double> altitudes_m;
  for (const StampedPose& pose : poses) {
    const double turns = static_cast<double>(pose.time_ns) * 1e-9 / options.period_s;
    altitudes_m.push_back(options.base_m +
                          options.amplitude_m * std::sin(2.0 * std::numbers::pi * turns));
  }
  return altitudes_m;
}

double measured_altitude(double altitude_m, double sigma_m, RandomStream& stream) {
  const double measured_m = altitude_m + sigma_m * stream.normal();
  if (measured_m > 0.0) return measured_m;
  throw InputError(kPrefix +
                   "altitude.altimeter_sigma_m: its noise lets a measured altitude fall " +
                   "below zero; expected a number in m well below " + kPrefix + "altitude.base_m");
}

UncertainPose noisy_motion(const Pose& motion, const Eigen::Matrix3d& covariance,
                           const MotionNoise& noise, RandomStream& stream) {
  const Eigen::Vector3d noisy = motion.vector() + noise.draw(stream);
  return {{noisy.x(), noisy.y(), wrap_angle(noisy.z())}, covariance};
}

std::string metres(double value) {
  char buffer[48];
  std::snprintf(buffer, sizeof buffer, "%.2f m", value);
  return buffer;
}

// Which side of the world a view leaves and by how much, or nothing.
std::string beyond(const Eigen::AlignedBox2d& world, const Eigen::AlignedBox2d& view) {
  const struct {
    const char* side;
    double by_m;
  } sides[] = {{"top", view.max().x() - world.max().x()},
               {"bottom", world.min().x() - view.min().x()},
               {"left", view.max().y() - world.max().y()},
               {"right", world.min().y() - view.min().y()}};
  const auto& worst =
      *std::max_element(std::begin(sides), std::end(sides),
                        [](const auto& a, const auto& b) { return a.by_m < b.by_m; });
  return worst.by_m > 0.0 ? metres(worst.by_m) + " beyond the picture's " + worst.side : "";
}

[[noreturn]] void refuse_view(const std::string& what, const FrameInfo& info, std::size_t frame,
                              const Eigen::Vector2d& mission_m, const Eigen::Vector2d& world_m) {
  std::string message = kPrefix + "world.picture: frame " + std::to_string(frame);
  message += " at " + seconds_text(info.time_ns) + " s sees " + what;
  message += "; the mission sees " + metres(mission_m.x()) + " up by " + metres(mission_m.y());
  message += " across, the picture has " + metres(world_m.x()) + " by " + metres(world_m.y());
  message +=
      ": shorten the mission, fly lower, or change world.metres_per_pixel, heading_rad, "
      "origin_x_m or origin_y_m";
  throw InputError(message);
}

// Boxes are in the axes of the picture, with the origin at frame 0.
void require_inside(const World& world, const std::vector<Eigen::AlignedBox2d>& boxes,
                    const Eigen::AlignedBox2d& all, const std::vector<FrameInfo>& infos) {
  const Eigen::AlignedBox2d extent = world.extent().translated(-world.mission.position());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const std::string what = beyond(extent, boxes[i]);
    if (!what.empty()) refuse_view(what, infos[i], i, all.sizes(), extent.sizes());
  }
}

}  // namespace

void AltitudeOptions::describe(OptionTable& table) {
  table.real("base_m", base_m, Range::positive(), "m",
             "mean altitude of the camera over the floor");
  table.real("amplitude_m", amplitude_m, Range::at_least(0), "m", "of its sine over time");
  table.real("period_s", period_s, Range::positive(), "s", "of its sine over time");
  table.real("altimeter_sigma_m", altimeter_sigma_m, Range::at_least(0), "m",
             "standard deviation of a measured altitude");
}

void SimulatedSurveyOptions::describe(OptionTable& table) {
  table.group("world", world);
  table.group("mission", mission);
  table.group("altitude", altitude);
  table.group("camera", camera);
  table.group("odometry", odometry);
}

SimulatedSurvey::SimulatedSurvey(const SimulatedSurveyOptions& given, std::uint64_t seed,
                                 std::uint64_t trial) {
  const SimulatedSurveyOptions options = checked(given);
  camera_ = camera_of(options.camera);
  measure(options, seed, trial);
  render_from(options.world, seed);
}

void SimulatedSurvey::measure(const SimulatedSurveyOptions& options, std::uint64_t seed,
                              std::uint64_t trial) {
  const std::vector<StampedPose> poses = fly_mission(options.mission, kPrefix + "mission.");
  const Eigen::Matrix3d covariance = options.odometry.noise_covariance(kPrefix + "odometry.");
  const MotionNoise noise(covariance);
  true_altitudes_m_ = true_altitudes(options.altitude, poses);
  has_odometry_ = options.odometry.source == OdometrySource::kNoisyMotion;
  RandomStream altimeter(seed, "altimeter", trial);
  RandomStream dead_reckoning(seed, "dead_reckoning", trial);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    FrameInfo info;
    info.time_ns = poses[i].time_ns;
    info.altitude_m =
        measured_altitude(true_altitudes_m_[i], options.altitude.altimeter_sigma_m, altimeter);
    if (has_odometry_ && i > 0) {
      info.motion = noisy_motion(between(poses[i - 1].pose, poses[i].pose), covariance, noise,
                                 dead_reckoning);
    }
    info.ground_truth = poses[i].pose;
    infos_.push_back(info);
  }
}

void SimulatedSurvey::render_from(const WorldOptions& options, std::uint64_t seed) {
  ViewRays rays(camera_);
  std::vector<Eigen::AlignedBox2d> boxes;
  Eigen::AlignedBox2d all;
  for (std::size_t i = 0; i < infos_.size(); ++i) {
    const Pose pose = compose({0, 0, options.heading_rad}, *infos_[i].ground_truth);
    boxes.push_back(rays.seen(pose, true_altitudes_m_[i]));
    all.extend(boxes.back());
  }
  World world = make_world(options, all, seed, kPrefix + "world.");
  require_inside(world, boxes, all, infos_);
  renderer_ = std::make_unique<const FloorRenderer>(camera_, std::move(rays), std::move(world));
}

cv::Mat SimulatedSurvey::image(std::size_t i) const {
  return renderer_->render(*infos_[i].ground_truth, true_altitudes_m_[i]);
}

}  // namespace fathom
