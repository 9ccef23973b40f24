#include "rigid_rank.hpp"

#include <algorithm>

#include "fathom/geometry/covariance.hpp"

namespace fathom {

HeldPose::HeldPose(const AbsolutePose& measurement, const Pose& in_set)
    : at(in_set.position()),
      information(transport(planar_rotation(measurement.pose.theta), measurement.information)) {}

// A turn by φ about the middle c of the positions moves a pose at p by φ J (p − c), so that it is
// the rank of N = Σ Gᵀ Ω G with G = [I  J (p − c); 0 1].
int rank_of_motions(std::span<const HeldPose> held) {
  double weights = 0.0;
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  double reach_m = 0.0;
  for (const HeldPose& pose : held) {
    const double weight = pose.information.topLeftCorner<2, 2>().trace();
    weights += weight;
    middle += weight * pose.at;
    reach_m = std::max(reach_m, pose.at.norm());
  }
  if (weights > 0.0) middle /= weights;
  Eigen::Matrix3d N = Eigen::Matrix3d::Zero();
  for (const HeldPose& pose : held) {
    const Eigen::Vector2d arm = pose.at - middle;
    Eigen::Matrix3d G = Eigen::Matrix3d::Identity();
    G.topRightCorner<2, 1>() = Eigen::Vector2d(-arm.y(), arm.x());
    N += transport(G.transpose(), pose.information);
  }
  // What the rounding of positions alone would make.
  constexpr double kRounding = 1e-12;
  if (!(N(2, 2) > kRounding * kRounding * weights * reach_m * reach_m)) {
    N.row(2).setZero();
    N.col(2).setZero();
  }
  return rank_of(N);
}

}  // namespace fathom
