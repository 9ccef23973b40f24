#pragma once

#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "fathom/datasets/world.hpp"
#include "fathom/geometry/pose.hpp"
#include "fathom/vision/camera.hpp"

namespace fathom {

/// Where each pixel of a camera looks: the floor point one metre below, from the camera's centre,
/// in the axes of the body. Undistortion is iterative, so it is done once for all frames.
class ViewRays {
 public:
  explicit ViewRays(const Camera& camera);

  /// Row-major, one for each pixel.
  const std::vector<Eigen::Vector2f>& rays() const { return rays_; }

  /// The bounding box of what is seen from a body at `pose` and an altitude, in the parent of the
  /// pose. Distortion bends the border, so all of the border's pixels count.
  Eigen::AlignedBox2d seen(const Pose& pose, double altitude_m) const;

 private:
  Eigen::Vector2d mount_m_;
  std::vector<Eigen::Vector2f> rays_;
  std::vector<Eigen::Vector2d> border_;
};

/// Raise it whenever a rendered picture or a drawn floor changes: pictures are known by it.
inline constexpr int kRendererVersion = 1;

/// Renders what a camera sees of a world: every pixel is traced to its floor point and looked up
/// there, bilinear in place and, where the camera resolves less than the world, between the two
/// nearest levels of an area-averaged pyramid (Williams, *Pyramidal Parametrics*, 1983).
class FloorRenderer {
 public:
  FloorRenderer(const Camera& camera, ViewRays rays, World world);

  const World& world() const { return world_; }

  /// The view of a body at `pose` (mission frame); 8-bit, one channel. What lies beyond the world
  /// repeats its border. May be called from several threads at once.
  cv::Mat render(const Pose& pose, double altitude_m) const;

 private:
  CameraModel camera_;
  ViewRays rays_;
  World world_;
  std::vector<cv::Mat> levels_;  ///< level l has 2^l world pixels to each of its own
};

}  // namespace fathom
