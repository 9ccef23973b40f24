#pragma once

#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "fathom/datasets/frame_source.hpp"
#include "fathom/report/mosaic.hpp"

namespace fathom::test {

/// A floor whose grey level is a formula: waves, a large bright blob 2 m ahead of the origin, and a
/// small dark one 1.5 m to port.
inline double floor_grey(const Eigen::Vector2d& point) {
  const auto blob = [&](double x, double y, double sigma_m) {
    return std::exp(-(point - Eigen::Vector2d(x, y)).squaredNorm() / (2 * sigma_m * sigma_m));
  };
  return 110 + 22 * std::sin(2.1 * point.x() + 0.4 * point.y()) +
         18 * std::sin(2.9 * point.y() - 0.9 * point.x() + 1.0) + 90 * blob(2.0, 0.0, 0.25) -
         60 * blob(0.0, 1.5, 0.15);
}

/// A camera that looks straight down from the origin, without distortion.
inline CameraModel plain_model() {
  CameraModel model;
  model.width = 120;
  model.height = 90;
  model.fx = model.fy = 120;
  model.cx = 59.5;
  model.cy = 44.5;
  return model;
}

/// One with all that a model may have.
inline CameraModel full_model() {
  CameraModel model = plain_model();
  model.fy = 125;
  model.cx = 55.0;
  model.distortion = {-0.15, 0.02, 0.002, -0.001, 0.0};
  model.mount_x_m = 0.3;
  model.mount_y_m = -0.1;
  model.mount_yaw_rad = 0.6;
  return model;
}

/// Pictures of that floor, each made by looking up the floor point of every pixel.
class KnownFloor : public FrameSource {
 public:
  /// The share of the light that arrives at a pixel.
  using Light = std::function<double(const Eigen::Vector2d& pixel)>;

  KnownFloor(const Camera& camera, std::vector<PlacedPicture> truth, Light light = {})
      : camera_(camera), truth_(std::move(truth)), light_(std::move(light)) {}

  const std::vector<PlacedPicture>& truth() const { return truth_; }

  const Camera& camera() const override { return camera_; }
  std::size_t size() const override { return truth_.size(); }
  const FrameInfo& info(std::size_t) const override { return info_; }
  cv::Mat image(std::size_t i) const override {
    cv::Mat picture(camera_.model().height, camera_.model().width, CV_8U);
    for (int v = 0; v < picture.rows; ++v) {
      for (int u = 0; u < picture.cols; ++u) {
        const Eigen::Vector2d pixel(u, v);
        const Eigen::Vector2d floor =
            transform(truth_[i].pose, camera_.floor_point(pixel, truth_[i].stance));
        picture.at<unsigned char>(v, u) =
            cv::saturate_cast<unsigned char>((light_ ? light_(pixel) : 1.0) * floor_grey(floor));
      }
    }
    return picture;
  }
  std::uint64_t picture_id(std::size_t i) const override { return i; }
  bool has_odometry() const override { return false; }
  bool has_ground_truth() const override { return false; }

 private:
  Camera camera_;
  std::vector<PlacedPicture> truth_;
  Light light_;
  FrameInfo info_;
};

/// Legs of 4 m, there and back, 0.5 m apart to port, at altitudes that change from 1.8 to 2.2 m.
inline std::vector<PlacedPicture> legs(int count) {
  std::vector<PlacedPicture> truth;
  for (int leg = 0; leg < count; ++leg) {
    for (int i = 0; i <= 10; ++i) {
      const double along_m = 0.4 * (leg % 2 == 0 ? i : 10 - i);
      const std::size_t frame = truth.size();
      truth.push_back({frame, 2.0 + 0.2 * std::sin(0.7 * static_cast<double>(frame)),
                       Pose{along_m - 1.0, 0.5 * leg - 0.3, leg % 2 == 0 ? 0.1 : 3.0}});
    }
  }
  return truth;
}

}  // namespace fathom::test
