#include "fathom/measurements/measured_parts.hpp"

#include <cmath>

#include <Eigen/LU>

#include "fathom/geometry/covariance.hpp"

namespace fathom {
namespace {

// Whatever the units.
bool has_full_rank(const Eigen::Matrix2d& W) {
  constexpr double kSmallest = 1e-12;
  const double product = W(0, 0) * W(1, 1);
  return product > 0.0 && product - W(0, 1) * W(1, 0) > kSmallest * product;
}

}  // namespace

MeasuredParts parts_of(const AbsolutePose& z) {
  MeasuredParts parts;
  const Eigen::Matrix3d& W = z.information;
  const Eigen::Matrix2d W_position = W.topLeftCorner<2, 2>();
  const bool has_position = has_full_rank(W_position);
  const bool has_all = has_position && rows_of(W).rank == 3;
  const Eigen::Matrix3d C = has_all ? symmetric_inverse(W) : Eigen::Matrix3d::Zero();
  if (has_position) {
    const Eigen::Matrix2d R = rotation(z.pose.theta);
    Eigen::Matrix2d own = W_position.inverse();
    if (has_all) own = C.topLeftCorner<2, 2>();
    parts.position = z.pose.position();
    parts.position_covariance = R * (0.5 * (own + own.transpose())) * R.transpose();
  }
  if (has_all || (!has_position && W(2, 2) > 0.0)) {
    parts.heading_rad = z.pose.theta;
    parts.heading_sigma_rad = std::sqrt(has_all ? C(2, 2) : 1.0 / W(2, 2));
  }
  return parts;
}

AbsolutePose moved(const AbsolutePose& z, const Pose& motion) {
  return {z.keyframe, compose(motion, z.pose), z.information};
}

}  // namespace fathom
