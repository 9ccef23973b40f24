#include "fathom/geometry/pose.hpp"

#include <cmath>
#include <numbers>

namespace fathom {

double wrap_angle(double angle_rad) {
  constexpr double kPi = std::numbers::pi;
  if (angle_rad > -kPi && angle_rad <= kPi) return angle_rad;
  // remainder() is exact and gives [−π, π]; only its lower end is not ours.
  const double wrapped = std::remainder(angle_rad, 2.0 * kPi);
  return wrapped <= -kPi ? kPi : wrapped;
}

Eigen::Matrix2d rotation(double theta_rad) {
  const double c = std::cos(theta_rad);
  const double s = std::sin(theta_rad);
  Eigen::Matrix2d R;
  R << c, -s, s, c;
  return R;
}

Eigen::Matrix3d planar_rotation(double theta_rad) {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  R.topLeftCorner<2, 2>() = rotation(theta_rad);
  return R;
}

bool is_finite(const Pose& pose) {
  return std::isfinite(pose.x) && std::isfinite(pose.y) && std::isfinite(pose.theta);
}

Pose compose(const Pose& X, const Pose& Y, Eigen::Matrix3d* result_X, Eigen::Matrix3d* result_Y) {
  const double c = std::cos(X.theta);
  const double s = std::sin(X.theta);
  const double dx = c * Y.x - s * Y.y;
  const double dy = s * Y.x + c * Y.y;
  if (result_X != nullptr) *result_X << 1, 0, -dy, 0, 1, dx, 0, 0, 1;
  if (result_Y != nullptr) *result_Y << c, -s, 0, s, c, 0, 0, 0, 1;
  return {X.x + dx, X.y + dy, wrap_angle(X.theta + Y.theta)};
}

Pose inverse(const Pose& X, Eigen::Matrix3d* result_X) {
  const double c = std::cos(X.theta);
  const double s = std::sin(X.theta);
  const Pose result{-c * X.x - s * X.y, s * X.x - c * X.y, wrap_angle(-X.theta)};
  if (result_X != nullptr) *result_X << -c, -s, result.y, s, -c, -result.x, 0, 0, -1;
  return result;
}

Pose between(const Pose& A, const Pose& B, Eigen::Matrix3d* result_A, Eigen::Matrix3d* result_B) {
  const double c = std::cos(A.theta);
  const double s = std::sin(A.theta);
  const double dx = B.x - A.x;
  const double dy = B.y - A.y;
  const Pose result{c * dx + s * dy, -s * dx + c * dy, wrap_angle(B.theta - A.theta)};
  if (result_A != nullptr) *result_A << -c, -s, result.y, s, -c, -result.x, 0, 0, -1;
  if (result_B != nullptr) *result_B << c, s, 0, -s, c, 0, 0, 0, 1;
  return result;
}

Eigen::Vector2d transform(const Pose& X, const Eigen::Vector2d& point) {
  return X.position() + rotation(X.theta) * point;
}

}  // namespace fathom
