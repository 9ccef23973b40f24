#include "fathom/vision/stance.hpp"

#include <Eigen/Geometry>

namespace fathom {

Eigen::Matrix3d Tilt::rotation() const {
  return (Eigen::AngleAxisd(pitch_rad, Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(roll_rad, Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

}  // namespace fathom
