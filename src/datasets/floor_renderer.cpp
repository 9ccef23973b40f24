#include "fathom/datasets/floor_renderer.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "fathom/core/input_error.hpp"

namespace fathom {
namespace {

std::vector<cv::Mat> area_pyramid(const cv::Mat& picture) {
  std::vector<cv::Mat> levels{picture};
  while (std::min(levels.back().rows, levels.back().cols) >= 4) {
    const cv::Mat& last = levels.back();
    const cv::Size half{last.cols / 2, last.rows / 2};
    // An odd last row or column is left out: any other ratio than two would shift the rest.
    cv::Mat next;
    cv::resize(last(cv::Rect(0, 0, 2 * half.width, 2 * half.height)), next, half, 0, 0,
               cv::INTER_AREA);
    levels.push_back(next);
  }
  return levels;
}

float bilinear(const cv::Mat& picture, float u, float v) {
  u = std::clamp(u, 0.0F, static_cast<float>(picture.cols - 1));
  v = std::clamp(v, 0.0F, static_cast<float>(picture.rows - 1));
  const int column = std::min(static_cast<int>(u), std::max(picture.cols - 2, 0));
  const int row = std::min(static_cast<int>(v), std::max(picture.rows - 2, 0));
  const int right = std::min(column + 1, picture.cols - 1);
  const float fu = u - static_cast<float>(column);
  const float fv = v - static_cast<float>(row);
  const uchar* top = picture.ptr(row);
  const uchar* bottom = picture.ptr(std::min(row + 1, picture.rows - 1));
  const float above =
      static_cast<float>(top[column]) * (1 - fu) + static_cast<float>(top[right]) * fu;
  const float below =
      static_cast<float>(bottom[column]) * (1 - fu) + static_cast<float>(bottom[right]) * fu;
  return above * (1 - fv) + below * fv;
}

// The pyramid between two of its levels. Level 0 has its first pixel's centre at 0, so its left
// edge, which all levels share, is at −1/2.
class Lookup {
 public:
  Lookup(const std::vector<cv::Mat>& levels, double world_pixels_per_pixel) {
    const double level =
        std::clamp(std::log2(world_pixels_per_pixel), 0.0, static_cast<double>(levels.size() - 1));
    const int fine = static_cast<int>(level);
    const std::size_t index = static_cast<std::size_t>(fine);
    fine_ = levels[index];
    coarse_ = levels[std::min(index + 1, levels.size() - 1)];
    scale_ = std::ldexp(1.0F, -fine);
    coarse_share_ = static_cast<float>(level - fine);
  }

  /// At a pixel of level 0.
  float at(const Eigen::Vector2f& pixel) const {
    const Eigen::Vector2f from_edge = scale_ * (pixel.array() + 0.5F);
    const float fine = bilinear(fine_, from_edge.x() - 0.5F, from_edge.y() - 0.5F);
    if (coarse_share_ == 0.0F) return fine;
    const float coarse =
        bilinear(coarse_, 0.5F * from_edge.x() - 0.5F, 0.5F * from_edge.y() - 0.5F);
    return fine + coarse_share_ * (coarse - fine);
  }

 private:
  cv::Mat fine_;
  cv::Mat coarse_;
  float scale_ = 1.0F;
  float coarse_share_ = 0.0F;
};

}  // namespace

ViewRays::ViewRays(const Camera& camera)
    : mount_m_(camera.model().mount_x_m, camera.model().mount_y_m) {
  const int width = camera.model().width;
  const int height = camera.model().height;
  rays_.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const Eigen::Vector2d ray = camera.floor_point({u, v}, 1.0) - mount_m_;
      if (!ray.allFinite()) {
        throw InputError("camera distortion cannot be undone at pixel (" + std::to_string(u) +
                         ", " + std::to_string(v) + "); expected coefficients k1 k2 p1 p2 k3");
      }
      rays_.push_back(ray.cast<float>());
      if (u == 0 || v == 0 || u == width - 1 || v == height - 1) border_.push_back(ray);
    }
  }
}

Eigen::AlignedBox2d ViewRays::seen(const Pose& pose, double altitude_m) const {
  const Eigen::Matrix2d R = rotation(pose.theta);
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& ray : border_) box.extend(R * (mount_m_ + altitude_m * ray));
  return box.translate(pose.position());
}

FloorRenderer::FloorRenderer(const Camera& camera, ViewRays rays, World world)
    : camera_(camera.model()),
      rays_(std::move(rays)),
      world_(std::move(world)),
      levels_(area_pyramid(world_.picture)) {}

cv::Mat FloorRenderer::render(const Pose& pose, double altitude_m) const {
  const Pose body = compose(world_.mission, pose);
  // Pixels of the world are affine in the ray: pixel = base + A ray.
  const Eigen::Vector2d mount{camera_.mount_x_m, camera_.mount_y_m};
  const Eigen::Vector2f base = world_.pixel(transform(body, mount)).cast<float>();
  const Eigen::Matrix2d R = rotation(body.theta) * (altitude_m / world_.metres_per_pixel);
  Eigen::Matrix2f A;
  A.row(0) = -R.row(1).cast<float>();
  A.row(1) = -R.row(0).cast<float>();

  const Lookup floor(levels_,
                     altitude_m / std::sqrt(camera_.fx * camera_.fy) / world_.metres_per_pixel);
  cv::Mat picture(camera_.height, camera_.width, CV_8UC1);
  const Eigen::Vector2f* ray = rays_.rays().data();
  for (int v = 0; v < picture.rows; ++v) {
    uchar* row = picture.ptr(v);
    for (int u = 0; u < picture.cols; ++u, ++ray) {
      row[u] = cv::saturate_cast<uchar>(floor.at(base + A * *ray));
    }
  }
  return picture;
}

}  // namespace fathom
