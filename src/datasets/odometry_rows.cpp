#include "fathom/datasets/odometry_rows.hpp"

#include <algorithm>
#include <numbers>
#include <utility>

namespace fathom {

const std::vector<std::pair<std::string, OdometryConvention>>& odometry_conventions() {
  static const std::vector<std::pair<std::string, OdometryConvention>> words{
      {"counter_clockwise_from_x", OdometryConvention::counter_clockwise_from_x},
      {"north_east_down", OdometryConvention::north_east_down},
      {"clockwise_from_x", OdometryConvention::clockwise_from_x},
      {"clockwise_from_y", OdometryConvention::clockwise_from_y},
      {"y_to_starboard", OdometryConvention::y_to_starboard}};
  return words;
}

std::string name_of(OdometryConvention convention) {
  return std::ranges::find(odometry_conventions(), convention,
                           &std::pair<std::string, OdometryConvention>::second)
      ->first;
}

namespace {

struct Senses {
  double y = 1.0;
  double heading = 1.0;
};

Senses senses_of(OdometryConvention convention) {
  switch (convention) {
    case OdometryConvention::north_east_down:
      return {-1.0, -1.0};
    case OdometryConvention::clockwise_from_x:
    case OdometryConvention::clockwise_from_y:
      return {1.0, -1.0};
    case OdometryConvention::y_to_starboard:
      return {-1.0, 1.0};
    case OdometryConvention::counter_clockwise_from_x:
      break;
  }
  return {};
}

}  // namespace

Pose OdometryFormat::pose(const ReckonedRow& row) const {
  const Senses senses = senses_of(convention);
  const double unit = is_in_degrees ? std::numbers::pi / 180.0 : 1.0;
  const double from_x =
      convention == OdometryConvention::clockwise_from_y ? std::numbers::pi / 2.0 : 0.0;
  return {scale * row.x_m, senses.y * scale * row.y_m,
          wrap_angle(from_x + senses.heading * unit * row.heading_rad)};
}

Eigen::Matrix3d OdometryFormat::covariance(const Eigen::Matrix3d& stated) const {
  const Senses senses = senses_of(convention);
  // As it is where nothing is to be turned: a negative zero would be another row.
  if (senses.y == 1.0 && senses.heading == 1.0 && scale == 1.0) return stated;
  const Eigen::Vector3d factors(scale, senses.y * scale, senses.heading);
  return factors.asDiagonal() * stated * factors.asDiagonal();
}

}  // namespace fathom
