#pragma once

#include <atomic>
#include <cstddef>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "fathom/core/hash.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/datasets/frame_source.hpp"
#include "vision/textured_floor.hpp"

namespace fathom::test {

/// A small camera, mounted off the body's origin and turned, so that a wrong frame shows.
inline CameraModel small_camera() {
  CameraModel model;
  model.width = 200;
  model.height = 150;
  model.fx = model.fy = 160.0;
  model.cx = 99.5;
  model.cy = 74.5;
  model.mount_x_m = 0.2;
  model.mount_yaw_rad = 0.3;
  return model;
}

inline constexpr double kAltitudeM = 1.5;

/// Pictures of a textured floor from given poses, kAltitudeM up: sees 1.9 m by 1.4 m. Some can be
/// made blank or unreadable. Counts how often each picture is asked for.
class FloorSurvey : public FrameSource {
 public:
  explicit FloorSurvey(std::vector<Pose> truth, const CameraModel& camera = small_camera())
      : camera_(camera), taken_(truth.size()) {
    for (std::size_t i = 0; i < truth.size(); ++i) {
      infos_.push_back(
          {static_cast<std::int64_t>(i) * 500'000'000, kAltitudeM, std::nullopt, truth[i]});
    }
  }

  /// The true motions, or each of them followed by a drift, with this covariance.
  void add_odometry(const Eigen::Matrix3d& covariance, const Pose& drift = {}) {
    has_odometry_ = true;
    for (std::size_t i = 1; i < infos_.size(); ++i) {
      const Pose motion = between(*infos_[i - 1].ground_truth, *infos_[i].ground_truth);
      infos_[i].motion = UncertainPose{compose(motion, drift), covariance};
    }
  }

  void set_altitude(std::size_t frame, double altitude_m) { infos_[frame].altitude_m = altitude_m; }
  void make_blank(std::size_t frame) { blank_.insert(frame); }
  void make_unreadable(std::size_t frame) { unreadable_.insert(frame); }
  int times_taken(std::size_t frame) const { return taken_[frame]; }
  const Pose& truth(std::size_t frame) const { return *infos_[frame].ground_truth; }

  const Camera& camera() const override { return camera_; }
  std::size_t size() const override { return infos_.size(); }
  const FrameInfo& info(std::size_t i) const override { return infos_[i]; }
  bool has_odometry() const override { return has_odometry_; }
  bool has_ground_truth() const override { return true; }

  std::uint64_t picture_id(std::size_t i) const override {
    const Pose& pose = truth(i);
    return Hash().add(pose.x).add(pose.y).add(pose.theta).add(blank_.contains(i)).value();
  }

  cv::Mat image(std::size_t i) const override {
    ++taken_[i];
    if (unreadable_.contains(i)) throw InputError("frame-" + std::to_string(i), "is no picture");
    const CameraModel& model = camera_.model();
    if (blank_.contains(i)) return cv::Mat(model.height, model.width, CV_8UC1, cv::Scalar(90));
    static const TexturedFloor floor(1500, 0.004, 11);
    return floor.seen(camera_, truth(i), kAltitudeM);
  }

 private:
  Camera camera_;
  std::vector<FrameInfo> infos_;
  std::set<std::size_t> blank_;
  std::set<std::size_t> unreadable_;
  mutable std::vector<std::atomic<int>> taken_;
  bool has_odometry_ = false;
};

/// A gentle bend to port, a step of 0.2 m.
inline std::vector<Pose> bend(std::size_t frames) {
  std::vector<Pose> poses{{-0.8, -0.5, 0.1}};
  while (poses.size() < frames) poses.push_back(compose(poses.back(), {0.2, 0.01, 0.04}));
  return poses;
}

}  // namespace fathom::test
