#include "estimators/invariant_ekf/invariant_ekf.hpp"

#include <cmath>

namespace fathom {

Pose exponential(const Eigen::Vector3d& twist) {
  const double phi = twist.z();
  // 1 − cos φ loses all its digits at small angles.
  const double half_sine = std::sin(0.5 * phi);
  const bool is_small = std::abs(phi) < 1e-4;
  const double a = is_small ? 1.0 - phi * phi / 6.0 : std::sin(phi) / phi;
  const double b = is_small ? 0.5 * phi : 2.0 * half_sine * half_sine / phi;
  return {a * twist.x() - b * twist.y(), b * twist.x() + a * twist.y(), wrap_angle(phi)};
}

std::optional<Eigen::Matrix3d> InvariantEkf::world_from_error(std::size_t k) const {
  const Pose X = pose(k);
  Eigen::Matrix3d G = Eigen::Matrix3d::Identity();
  G.topRightCorner<2, 1>() << -X.y, X.x;
  return G;
}

Pose InvariantEkf::corrected(const Pose& pose, const Eigen::Vector3d& error) const {
  return compose(exponential(error), pose);
}

EstimatorEntry invariant_ekf_entry() {
  return filter::delayed_state_entry<InvariantEkf>(
      "invariant_ekf", "delayed-state EKF with a right-invariant error on SE(2)");
}

}  // namespace fathom
