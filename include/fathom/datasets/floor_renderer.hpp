#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "fathom/datasets/attitude.hpp"
#include "fathom/datasets/picture_effects.hpp"
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
  /// pose. Distortion bends the border, so all of the border's pixels count. Throws InputError
  /// where a tilt lets the camera see the horizon.
  Eigen::AlignedBox2d seen(const Pose& pose, double altitude_m, const Tilt& tilt = {}) const;

 private:
  Eigen::Vector2d mount_m_;
  std::vector<Eigen::Vector2f> rays_;
  std::vector<Eigen::Vector2d> border_;
};

/// One look at a floor.
struct View {
  Pose pose;                ///< of the body, mission frame
  double altitude_m = 0.0;  ///< of the camera over the floor's mean plane, > 0
  Tilt tilt = {};
  double motion_rad = 0.0;  ///< where the body moves, in its axes: 0 ahead, counter-clockwise
  std::uint64_t seed = 0;   ///< of all that is new in every picture
};

/// Raise it whenever a rendered picture or a drawn floor changes: pictures are known by it.
inline constexpr int kRendererVersion = 1;

/// Renders what a camera sees of a world: every pixel is traced to its floor point and looked up
/// there, bilinear in place and, where the camera resolves less than the world, between the two
/// nearest levels of an area-averaged pyramid (Williams, *Pyramidal Parametrics*, 1983). On a
/// relief the point is found by fixed-point iteration, which holds for slopes well below one; what
/// a crest hides is not modelled.
class FloorRenderer {
 public:
  FloorRenderer(const Camera& camera, ViewRays rays, World world);

  const World& world() const { return world_; }

  /// A view of the world through the water and by a camera as of `effects` (docs/water.md); 8-bit,
  /// one channel. What lies beyond the world repeats its border. May be called from several threads
  /// at once: the same view is the same picture.
  cv::Mat render(const View& view, const PictureEffects& effects = {}) const;

  /// A level view in clear water.
  cv::Mat render(const Pose& pose, double altitude_m) const { return render({pose, altitude_m}); }

 private:
  cv::Mat_<float> trace(const View& view, const PictureEffects& effects) const;

  CameraModel camera_;
  ViewRays rays_;
  World world_;
  std::vector<cv::Mat> levels_;
};

}  // namespace fathom
