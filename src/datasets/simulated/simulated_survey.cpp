#include "simulated_survey.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

#include "checked_options.hpp"
#include "fathom/core/hash.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/once.hpp"
#include "fathom/core/random.hpp"
#include "fathom/datasets/mission.hpp"
#include "seen_floor.hpp"

namespace fathom {
namespace {

const std::string kPrefix = "dataset.";

Camera camera_of(const CameraOptions& options) {
  try {
    return Camera(options.model(kPrefix + "camera."));
  } catch (const InputError& error) {
    const std::string what = error.what();
    if (what.starts_with(kPrefix)) throw;
    throw InputError(kPrefix + "camera: " + what);
  }
}

// Where a body moves on, seen in its own axes.
double motion_direction(const std::vector<FrameInfo>& infos, std::size_t i) {
  if (infos.size() < 2) return 0.0;
  const bool is_last = i + 1 == infos.size();
  const Pose& here = *infos[i].ground_truth;
  const Pose step = between(here, *infos[is_last ? i - 1 : i + 1].ground_truth);
  return is_last ? std::atan2(-step.y, -step.x) : std::atan2(step.y, step.x);
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

// A tilt may be measured where the true one does not see the horizon.
MeasuredTilt measured_tilt(const Camera& camera, double altitude_m, const MeasuredTilt& measured) {
  try {
    camera.footprint({altitude_m, measured.tilt});
  } catch (const InputError& error) {
    throw InputError(kPrefix + "attitude.measured_sigma_rad: " + error.what() +
                     " as measured; expected smaller noise and mounting errors");
  }
  return measured;
}

}  // namespace

// What pictures are rendered from; made when the first one is asked for.
class SimulatedSurvey::Floor {
 public:
  Floor(const Camera& camera, ViewRays rays, WorldPlan plan)
      : camera_(camera), rays_(std::move(rays)), plan_(std::move(plan)) {
    Hash hash;
    hash.add("rendered picture").add(kRendererVersion);
    camera_.model().add_to(hash);
    plan_.add_to(hash);
    id_ = hash.value();
  }

  const FloorRenderer& renderer() {
    once_.call([&] {
      renderer_ = std::make_unique<const FloorRenderer>(camera_, std::move(rays_), plan_.make());
      plan_.picture.release();
      is_drawn_ = true;
    });
    return *renderer_;
  }
  bool is_drawn() const { return is_drawn_; }
  std::uint64_t id() const { return id_; }

 private:
  Camera camera_;
  ViewRays rays_;
  WorldPlan plan_;
  std::uint64_t id_ = 0;
  Once once_;
  std::unique_ptr<const FloorRenderer> renderer_;
  std::atomic<bool> is_drawn_ = false;
};

SimulatedSurvey::SimulatedSurvey(const SimulatedSurveyOptions& given, std::uint64_t seed,
                                 std::uint64_t trial) {
  const SimulatedSurveyOptions options = checked(given, "dataset");
  camera_ = camera_of(options.camera);
  effects_ = options.effects;
  effects_.check(kPrefix);
  options.attitude.check(kPrefix + "attitude.");
  fly(options);
  measure_altitudes(options.altitude.altimeter_sigma_m, seed);
  measure_motions(options.odometry, seed, trial);
  measure_sensors(options.sensors, seed, trial);
  plan_views(options, seed);
  plan_floor(options.world, seed);
}

void SimulatedSurvey::fly(const SimulatedSurveyOptions& options) {
  const std::vector<StampedPose> poses = fly_mission(options.mission, kPrefix + "mission.");
  // A covariance that cannot be is said before an altitude.
  options.odometry.noise_covariance(kPrefix + "odometry.");
  const std::vector<double> altitudes_m = true_altitudes(options.altitude, poses);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    FrameInfo info;
    info.time_ns = poses[i].time_ns;
    info.ground_truth = poses[i].pose;
    infos_.push_back(info);
    views_.push_back({poses[i].pose, altitudes_m[i]});
  }
}

void SimulatedSurvey::measure_altitudes(double sigma_m, std::uint64_t seed) {
  RandomStream altimeter(seed, "altimeter");
  for (std::size_t i = 0; i < infos_.size(); ++i) {
    infos_[i].altitude_m = measured_altitude(views_[i].altitude_m, sigma_m, altimeter);
  }
}

void SimulatedSurvey::plan_views(const SimulatedSurveyOptions& options, std::uint64_t seed) {
  const double period_s = 1.0 / options.mission.frame_rate_hz;
  const auto tilts = draw_attitude(options.attitude, views_.size(), period_s, seed);
  const auto measured = measure_attitude(options.attitude, tilts, seed);
  for (std::size_t i = 0; i < views_.size(); ++i) {
    views_[i].tilt = tilts[i];
    if (!measured.empty())
      infos_[i].tilt = measured_tilt(camera_, infos_[i].altitude_m, measured[i]);
    views_[i].motion_rad = motion_direction(infos_, i);
    views_[i].seed = stream_seed(seed, "picture_effects", i);
  }
}

void SimulatedSurvey::plan_floor(const WorldOptions& options, std::uint64_t seed) {
  ViewRays rays(camera_);
  const SeenFloor seen = seen_floor(rays, views_, options, kPrefix);
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const View& view : views_) nearest_m = std::min(nearest_m, view.altitude_m);
  if (options.relief_m >= nearest_m) {
    throw InputError(kPrefix +
                     "world.relief_m: the floor may reach the camera; expected a number " +
                     "in m below the least altitude, " + std::to_string(nearest_m));
  }
  const double finest_m = finest_pixel_m(camera_.model(), nearest_m - options.relief_m);
  WorldPlan plan = plan_world(options, {seen.all, finest_m}, seed, kPrefix + "world.");
  require_inside(plan, seen, infos_, kPrefix);
  floor_ = std::make_shared<Floor>(camera_, std::move(rays), std::move(plan));
}

cv::Mat SimulatedSurvey::image(std::size_t i) const {
  return floor_->renderer().render(views_[i], effects_);
}

std::uint64_t SimulatedSurvey::picture_id(std::size_t i) const {
  const View& view = views_[i];
  Hash hash;
  hash.add(floor_->id()).add(view.pose.x).add(view.pose.y).add(view.pose.theta);
  hash.add(view.altitude_m);
  // A level view in clear water has no more words, so that its number is what it always was.
  if (!view.tilt.is_level()) hash.add("tilt").add(view.tilt.roll_rad).add(view.tilt.pitch_rad);
  if (effects_.any()) {
    effects_.add_to(hash.add("effects"));
    if (effects_.is_random()) hash.add(view.seed);
    if (effects_.camera.motion_blur_px > 0.0) hash.add("way in the picture").add(view.motion_rad);
  }
  return hash.value();
}

const World& SimulatedSurvey::world() const {
  return floor_->renderer().world();
}

bool SimulatedSurvey::is_world_drawn() const {
  return floor_->is_drawn();
}

}  // namespace fathom
