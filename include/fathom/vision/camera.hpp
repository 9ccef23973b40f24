#pragma once

#include <array>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "fathom/core/hash.hpp"
#include "fathom/geometry/pose.hpp"

namespace fathom {

/// A downward pinhole camera with radial-tangential distortion (Brown; OpenCV's k1 k2 p1 p2 k3) and
/// its mounting in the body frame. Pixels are at their centres: (0, 0) is the centre of the first.
struct CameraModel {
  int width = 640;
  int height = 480;
  double fx = 500.0;  ///< pixels
  double fy = 500.0;
  double cx = 319.5;
  double cy = 239.5;
  std::array<double, 5> distortion{};  ///< k1 k2 p1 p2 k3; all zero: none
  double mount_x_m = 0.0;              ///< camera centre in the body frame
  double mount_y_m = 0.0;
  double mount_yaw_rad = 0.0;  ///< counter-clockwise seen from above; 0: picture top forward

  bool has_distortion() const;

  /// All of its numbers.
  void add_to(Hash& hash) const;
};

/// The one place where pixels become metres on the floor, and back (docs/conventions.md):
///
///     body point = Rot(yaw) · (−(v − c_y)/f_y, −(u − c_x)/f_x) · altitude + (mount_x, mount_y)
///
/// for an undistorted pixel (u, v), u to the right and v down. All calls throw InputError on an
/// altitude that is not a positive number of metres.
class Camera {
 public:
  /// Throws InputError on a size or focal length that is not positive, on numbers that are not
  /// finite, and on a distortion that folds the picture over, so that a pixel has no one ray.
  explicit Camera(const CameraModel& model = {});

  const CameraModel& model() const { return model_; }

  /// The point of the floor seen at a (distorted) pixel, in the body frame, for a camera
  /// `altitude_m` above a flat floor. Distortion is undone to 1e-12 of the focal length. NaN for a
  /// pixel so far outside the picture that the distortion reaches it from nowhere.
  Eigen::Vector2d floor_point(const Eigen::Vector2d& pixel, double altitude_m) const;

  /// floor_point of each pixel.
  std::vector<Eigen::Vector2d> floor_points(std::span<const Eigen::Vector2d> pixels,
                                            double altitude_m) const;

  /// The heading, in the body frame, of a direction in the picture: 0 is u, a quarter turn v. The
  /// two turn opposite ways. Lens distortion, which turns it by little, is not undone.
  double heading(double turn_rad) const;

  /// The pixel at which a body-frame point of the floor is seen, distortion applied. A polynomial
  /// distortion is good for the picture alone: a point far outside it may come back in.
  Eigen::Vector2d pixel(const Eigen::Vector2d& floor_point, double altitude_m) const;

  /// The four corners of what the picture covers, body frame, in the order top left, top right,
  /// bottom right, bottom left of the picture. Pixels are squares about their centres, so the top
  /// left corner is that of pixel (−0.5, −0.5).
  std::array<Eigen::Vector2d, 4> footprint(double altitude_m) const;

 private:
  Eigen::Vector2d on_floor(const Eigen::Vector2d& pixel, double altitude_m) const;

  CameraModel model_;
  Eigen::Matrix2d body_from_mount_;
};

/// The share of the smaller one of two footprints that both pictures see, 0 to 1. `motion`: the
/// pose of b in the frame of a. Throws InputError on an altitude that is not positive.
double footprint_overlap(const Camera& camera, double altitude_a_m, double altitude_b_m,
                         const Pose& motion);

}  // namespace fathom
