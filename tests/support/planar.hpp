#pragma once

// Planar geometry a second time, through 3×3 homogeneous matrices, so that tests do not check the
// library against itself.

#include <cmath>
#include <functional>

#include <Eigen/Core>
#include <Eigen/LU>

#include "fathom/core/random.hpp"
#include "fathom/geometry/pose.hpp"

namespace fathom::test {

inline Eigen::Matrix3d homogeneous(const Pose& pose) {
  Eigen::Matrix3d T;
  T << std::cos(pose.theta), -std::sin(pose.theta), pose.x,  //
      std::sin(pose.theta), std::cos(pose.theta), pose.y,    //
      0, 0, 1;
  return T;
}

/// (x, y, θ) of a homogeneous matrix; θ by atan2, in [−π, π].
inline Eigen::Vector3d t2v(const Eigen::Matrix3d& T) {
  return {T(0, 2), T(1, 2), std::atan2(T(1, 0), T(0, 0))};
}

/// Heading difference by atan2, not by the library's wrap.
inline double angle_between(double a, double b) {
  return std::atan2(std::sin(a - b), std::cos(a - b));
}

inline double distance(const Pose& a, const Pose& b) {
  return std::max(std::hypot(a.x - b.x, a.y - b.y), std::abs(angle_between(a.theta, b.theta)));
}

inline Pose random_pose(RandomStream& random, double extent_m = 10.0) {
  return {random.uniform(-extent_m, extent_m), random.uniform(-extent_m, extent_m),
          random.uniform(-3.14159, 3.14159)};
}

/// A full covariance: A Aᵀ of a random A, scaled.
inline Eigen::Matrix3d random_covariance(RandomStream& random, double scale = 1.0) {
  Eigen::Matrix3d A;
  for (int i = 0; i < 9; ++i) A(i / 3, i % 3) = random.normal();
  return scale * (A * A.transpose() + 0.1 * Eigen::Matrix3d::Identity());
}

/// Central differences of f: (x, y, θ) → (x, y, θ), the third row wrapped.
inline Eigen::Matrix3d numerical_jacobian(const std::function<Eigen::Vector3d(const Pose&)>& f,
                                          const Pose& at, double step = 1e-6) {
  Eigen::Matrix3d J;
  for (int column = 0; column < 3; ++column) {
    Eigen::Vector3d high = at.vector();
    Eigen::Vector3d low = at.vector();
    high[column] += step;
    low[column] -= step;
    Eigen::Vector3d difference = f(Pose::from_vector(high)) - f(Pose::from_vector(low));
    difference.z() = std::atan2(std::sin(difference.z()), std::cos(difference.z()));
    J.col(column) = difference / (2.0 * step);
  }
  return J;
}

}  // namespace fathom::test
