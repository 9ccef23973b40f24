#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "attitude.hpp"
#include "fathom/geometry/pose.hpp"
#include "fathom/vision/camera.hpp"
#include "picture_effects.hpp"
#include "world.hpp"

namespace fathom {

/// Where the corners of a camera's pixels look: the floor point one metre below, from the camera's
/// centre, in the axes of the body. Undistortion is iterative, so it is done once for all frames.
class ViewRays {
 public:
  /// Throws InputError where the distortion cannot be undone.
  explicit ViewRays(const Camera& camera);

  /// Row-major, (height + 1) × (width + 1): the corner (u − ½, v − ½) at row v and column u.
  const std::vector<Eigen::Vector2f>& corners() const { return corners_; }

  /// The bounding box of what is seen from a body at `pose` and an altitude, in the parent of the
  /// pose. Distortion bends the border, so all corners along it count. Throws InputError where a
  /// tilt lets the camera see the horizon.
  Eigen::AlignedBox2d seen(const Pose& pose, double altitude_m, const Tilt& tilt = {}) const;

 private:
  Eigen::Vector2d mount_m_;
  std::vector<Eigen::Vector2f> corners_;
  std::vector<Eigen::Vector2d> border_;
};

/// The shorter side of a pixel on a floor so far below a level camera; metres.
double finest_pixel_m(const CameraModel& camera, double altitude_m);

/// One look at a floor.
struct View {
  Pose pose;                ///< of the body, mission frame
  double altitude_m = 0.0;  ///< of the camera over the floor's mean plane, > 0
  Tilt tilt = {};
  double motion_rad = 0.0;  ///< where the body moves, in its axes: 0 ahead, counter-clockwise
  std::uint64_t seed = 0;   ///< of all that is new in every picture
};

/// Raise it whenever a rendered picture or a drawn floor changes: pictures are known by it.
inline constexpr int kRendererVersion = 2;

/// Renders what a camera sees of a world. A pixel is the mean of kSamplesAcross² samples over the
/// floor between its four corners, each bilinear in a level of an area-averaged pyramid that has
/// two to four pixels to one of the camera: a single sample of a floor as coarse as the picture
/// moves all features of the picture by an amount that depends on where its grid meets the floor's.
/// The world is to be at least twice as fine as the finest pixel of the camera (finest_pixel_m,
/// refined). On a relief the floor point of a corner is found by fixed-point iteration, which holds
/// for slopes well below one; what a crest hides is not modelled.
class FloorRenderer {
 public:
  /// Samples along each side of a pixel: one or less for each pixel of the pyramid below.
  static constexpr int kSamplesAcross = 4;

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

  Camera camera_;
  ViewRays rays_;
  World world_;
  std::vector<cv::Mat> levels_;
};

}  // namespace fathom
