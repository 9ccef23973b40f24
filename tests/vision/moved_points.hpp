#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "fathom/vision/registration.hpp"
#include "vision/fitted_points.hpp"

namespace fathom::test {

// What a camera is off by: altitude, and turns of the body about its x and y axes.
struct CameraError {
  double altitude_m = 0.0;
  double roll_rad = 0.0;
  double pitch_rad = 0.0;

  double& operator[](int i) { return i == 0 ? altitude_m : i == 1 ? roll_rad : pitch_rad; }
};

// A camera of the pitch and of a roll turned by the error; of a level one in the other order.
inline Eigen::Matrix3d turn_of(double pitch_rad, const CameraError& error) {
  return (Eigen::AngleAxisd(pitch_rad + error.pitch_rad, Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(error.roll_rad, Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

// Where the ray that the camera takes for the one to `point` meets the floor with the error, in
// three dimensions: x ahead, y to the left, z up. A roll of its own changes nothing: the error adds
// to it about the same axis.
inline Eigen::Vector2d moved(const Eigen::Vector2d& point, const Viewpoint& view,
                             const CameraError& error) {
  const Eigen::Vector3d ray(point.x() - view.camera_m.x(), point.y() - view.camera_m.y(),
                            -view.altitude_m);
  const Eigen::Vector3d turned =
      turn_of(view.pitch_rad, error) * turn_of(view.pitch_rad, {}).transpose() * ray;
  const double length = -(view.altitude_m + error.altitude_m) / turned.z();
  return view.camera_m + length * turned.head<2>();
}

inline Points all_moved(const Points& points, const Viewpoint& view, const CameraError& error) {
  Points result;
  for (const Eigen::Vector2d& point : points) result.push_back(moved(point, view, error));
  return result;
}

inline Viewpoint view_from(double altitude_m) {
  Viewpoint view;
  view.camera_m = {0.4, -0.1};
  view.altitude_m = altitude_m;
  return view;
}

// Matches without any error.
struct Overlap {
  Pose motion{0.6, -0.4, 0.9};
  Viewpoint from = view_from(2.0);
  Viewpoint to = view_from(1.4);
  Points p, q;
  std::vector<double> weights;

  explicit Overlap(int matches = 40) {
    RandomStream random(8);
    q = random_points(random, matches, {0.9, 0.3});
    p = seen_from(motion, q);
    weights = random_weights(random, q.size());
  }
};

}  // namespace fathom::test
