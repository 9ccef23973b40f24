#pragma once

#include <utility>
#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "fathom/geometry/pose.hpp"
#include "fathom/vision/camera.hpp"

namespace fathom {

/// A square of floor with texture at many scales, seen from above with x up and y to the left; its
/// middle is the world's origin.
class TexturedFloor {
 public:
  TexturedFloor(int side_px, double metres_per_pixel, int seed)
      : metres_per_pixel_(metres_per_pixel) {
    cv::RNG random(static_cast<std::uint64_t>(seed));
    cv::Mat sum = cv::Mat::zeros(side_px, side_px, CV_32F);
    for (const double blur_px : {1.5, 3.0, 6.0, 12.0}) {
      cv::Mat noise(side_px, side_px, CV_32F);
      random.fill(noise, cv::RNG::NORMAL, 0.0, 1.0);
      cv::GaussianBlur(noise, noise, cv::Size(), blur_px);
      sum += noise * blur_px;  // equal power in each
    }
    cv::normalize(sum, picture_, 0.0, 255.0, cv::NORM_MINMAX, CV_8U);
  }

  /// One of a picture.
  TexturedFloor(cv::Mat picture, double metres_per_pixel)
      : metres_per_pixel_(metres_per_pixel), picture_(std::move(picture)) {}

  /// What a camera at `pose` sees.
  cv::Mat seen(const Camera& camera, const Pose& pose, double altitude_m) const {
    const CameraModel& model = camera.model();
    cv::Mat map(model.height, model.width, CV_32FC2);
    const double middle = (picture_.rows - 1) / 2.0;
    for (int v = 0; v < model.height; ++v) {
      for (int u = 0; u < model.width; ++u) {
        const Eigen::Vector2d point =
            transform(pose, camera.floor_point(Eigen::Vector2d(u, v), altitude_m));
        map.at<cv::Vec2f>(v, u) = {static_cast<float>(middle - point.y() / metres_per_pixel_),
                                   static_cast<float>(middle - point.x() / metres_per_pixel_)};
      }
    }
    cv::Mat seen;
    cv::remap(picture_, seen, map, cv::noArray(), cv::INTER_LINEAR, cv::BORDER_REFLECT);
    return seen;
  }

  const cv::Mat& picture() const { return picture_; }

 private:
  double metres_per_pixel_;
  cv::Mat picture_;
};

}  // namespace fathom
