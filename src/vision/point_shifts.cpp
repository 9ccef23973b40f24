#include "point_shifts.hpp"

#include <cmath>

#include <Eigen/Geometry>

namespace fathom {

// A turn by dφ about an axis w, through the camera, moves the ray (r, −1), r = (p − camera) /
// altitude, by dφ w × (r, −1); pitch turns about y, roll about the x axis that pitch has turned,
// w = (cos pitch, 0, −sin pitch) (docs/conventions.md). Of a level camera the ray meets the floor
// at camera + altitude · (r_x − pitch, r_y + roll) · (1 + roll r_y − pitch r_x), to first order.
Eigen::Matrix<double, 2, 3> shift_by_errors(const Viewpoint& view, const Eigen::Vector2d& p) {
  const Eigen::Vector2d r = (p - view.camera_m) / view.altitude_m;
  Eigen::Matrix<double, 2, 3> J;
  J.col(0) = r;
  const double c = std::cos(view.pitch_rad);
  const double s = std::sin(view.pitch_rad);
  J.col(1) = view.altitude_m * Eigen::Vector2d(c * (r.x() * r.y()) + s * r.y(),
                                               c * (1.0 + r.y() * r.y()) - s * r.x());
  J.col(2) = -view.altitude_m * Eigen::Vector2d(1.0 + r.x() * r.x(), r.x() * r.y());
  return J;
}

// The ray v turns to u / −v_z, u its x and y; the second derivative of that at v_z = −1.
Eigen::Matrix<double, 2, 3> shift_by_tilts(const Viewpoint& view, const Eigen::Vector2d& p) {
  const Eigen::Vector2d r = (p - view.camera_m) / view.altitude_m;
  const Eigen::Vector3d v(r.x(), r.y(), -1.0);
  const Eigen::Vector3d roll(std::cos(view.pitch_rad), 0.0, -std::sin(view.pitch_rad));
  const Eigen::Vector3d pitch = Eigen::Vector3d::UnitY();
  const auto f = [&](const Eigen::Vector3d& v_i, const Eigen::Vector3d& v_j,
                     const Eigen::Vector3d& v_ij) -> Eigen::Vector2d {
    return v_ij.head<2>() + v_j.z() * v_i.head<2>() + v_i.z() * v_j.head<2>() +
           (v_ij.z() + 2.0 * v_i.z() * v_j.z()) * r;
  };
  const Eigen::Vector3d v_r = roll.cross(v);
  const Eigen::Vector3d v_p = pitch.cross(v);
  Eigen::Matrix<double, 2, 3> second;
  second << f(v_r, v_r, roll.cross(v_r)), f(v_p, v_p, pitch.cross(v_p)),
      f(v_r, v_p, pitch.cross(v_r));
  return view.altitude_m * second;
}

}  // namespace fathom
