#pragma once

#include <array>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "fathom/core/hash.hpp"
#include "fathom/geometry/pose.hpp"
#include "fathom/vision/distortion_model.hpp"
#include "fathom/vision/stance.hpp"

namespace fathom {

/// A downward pinhole camera with the distortion of its lens, and its mounting in the body frame.
/// Pixels are at their centres: (0, 0) is the centre of the first.
struct CameraModel {
  int width = 640;
  int height = 480;
  double fx = 500.0;  ///< pixels
  double fy = 500.0;
  double cx = 319.5;
  double cy = 239.5;
  DistortionModel distortion_model = DistortionModel::radial_tangential;
  std::array<double, 8> distortion{};  ///< its coefficients, zeros behind them
  double mount_x_m = 0.0;              ///< camera centre in the body frame
  double mount_y_m = 0.0;
  double mount_yaw_rad = 0.0;  ///< counter-clockwise seen from above; 0: picture top forward
  /// Left and right are exchanged in the pictures, as behind a mirror; all numbers above are of the
  /// pictures as they are.
  bool is_mirrored = false;

  /// Whether a straight line is bent: an equidistant lens without coefficients does so, too.
  bool has_distortion() const;

  /// Whether the sides of what the picture covers are taken for straight, from corner to corner: of
  /// a radial-tangential lens, which bends them by little.
  bool has_straight_sides() const;

  /// All of its numbers.
  void add_to(Hash& hash) const;
};

/// The one place where pixels become metres on the floor, and back (docs/conventions.md):
///
///     body point = Rot(yaw) · (−(v − c_y)/f_y, −(u − c_x)/f_x) · altitude + (mount_x, mount_y)
///
/// for an undistorted pixel (u, v), u to the right and v down, and a level camera; of mirrored
/// pictures +(u − c_x)/f_x. Of a tilted one
/// the same ray is turned by Rot_y(pitch) Rot_x(roll) about the camera's centre, which is
/// `altitude_m` above the floor. The body frame stays level: its axes are the heading's. All calls
/// throw InputError on an altitude that is not a positive number of metres, and on a tilt that is
/// not finite.
class Camera {
 public:
  /// Throws InputError on a size or focal length that is not positive, on numbers that are not
  /// finite, on a distortion that folds the picture over, so that a pixel has no one ray, and on a
  /// fisheye's pixel at a quarter turn or more from the axis, where no floor is.
  explicit Camera(const CameraModel& model = {});

  const CameraModel& model() const { return model_; }

  /// The point of the floor seen at a (distorted) pixel, in the body frame. Distortion is undone to
  /// 1e-12 of the focal length. NaN for a pixel so far outside the picture that the distortion
  /// reaches it from nowhere, and for one that sees the horizon or what is above it.
  Eigen::Vector2d floor_point(const Eigen::Vector2d& pixel, const Stance& stance) const;

  /// floor_point of each pixel.
  std::vector<Eigen::Vector2d> floor_points(std::span<const Eigen::Vector2d> pixels,
                                            const Stance& stance) const;

  /// The heading, in the body frame, of a direction in the picture: 0 is u, a quarter turn v. The
  /// two turn opposite ways. Lens distortion is not undone.
  double heading(double turn_rad) const;

  /// What a tilt, and a lens that is not radial-tangential, make of a small neighbourhood of a
  /// pixel. Radial-tangential distortion, which turns by little, is not undone.
  struct Neighbourhood {
    double heading_rad = 0.0;  ///< of a direction in the picture there, as above
    double stretch = 1.0;      ///< of lengths, their geometric mean, against those on the axis of a
                               ///< level camera
  };
  Neighbourhood neighbourhood(const Eigen::Vector2d& pixel, double turn_rad,
                              const Tilt& tilt) const;

  /// The pixel at which a body-frame point of the floor is seen, distortion applied. Distortion
  /// is good for the picture alone: a point far outside it may come back in. NaN for a point behind
  /// a tilted camera.
  Eigen::Vector2d pixel(const Eigen::Vector2d& floor_point, const Stance& stance) const;

  /// The four corners of what the picture covers, body frame, in the order top left, top right,
  /// bottom right, bottom left of the picture. Pixels are squares about their centres, so the top
  /// left corner is that of pixel (−0.5, −0.5); of mirrored pictures it is the top right one, so
  /// that the order is that of the floor. Throws InputError where one sees the horizon.
  std::array<Eigen::Vector2d, 4> footprint(const Stance& stance) const;

  /// The same with so many steps from corner to corner, as distortion bends the sides. Throws
  /// likewise.
  std::vector<Eigen::Vector2d> outline(const Stance& stance, int steps) const;

 private:
  Neighbourhood level_neighbourhood(const Eigen::Vector2d& pixel, double turn_rad) const;
  double heading_of(const Eigen::Vector2d& in_image) const;
  Eigen::Vector2d ray_of(const Eigen::Vector2d& image) const;
  Eigen::Vector2d image_point(const Eigen::Vector2d& pixel) const;
  Eigen::Vector2d level_ray(const Eigen::Vector2d& pixel) const;
  Eigen::Vector2d on_floor(const Eigen::Vector2d& pixel, const Stance& stance,
                           const Eigen::Matrix3d& tilt) const;

  CameraModel model_;
  Eigen::Matrix2d body_from_mount_;
  double reach_rad_ = 0.0;  ///< of the lens (reach_of)
};

/// The share of the smaller one of two footprints that both pictures see, 0 to 1. `motion`: the
/// pose of b in the frame of a. Throws InputError as Camera::footprint.
double footprint_overlap(const Camera& camera, const Stance& stance_a, const Stance& stance_b,
                         const Pose& motion);

}  // namespace fathom
