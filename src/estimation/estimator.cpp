#include "fathom/estimation/estimator.hpp"

#include <array>

#include "fathom/geometry/covariance.hpp"

namespace fathom {

std::optional<Eigen::Matrix3d> Estimate::covariance(std::size_t k) const {
  const auto joint = joint_covariance(std::span(&k, 1));
  if (!joint) return std::nullopt;
  return Eigen::Matrix3d(*joint);
}

std::optional<Eigen::Matrix3d> Estimate::newest_covariance() const {
  const std::size_t newest = size() - 1;
  const auto joint = joint_covariance(std::span(&newest, 1));
  if (!joint) return std::nullopt;
  return Eigen::Matrix3d(*joint);
}

std::optional<std::vector<UncertainPose>> Estimate::motions_to_newest() const {
  std::vector<UncertainPose> motions;
  const std::size_t newest = size() - 1;
  for (std::size_t k = 0; k < newest; ++k) {
    const std::array<std::size_t, 2> ends{k, newest};
    const auto joint = joint_covariance(ends);
    if (!joint) return std::nullopt;
    const PairCovariance pair{joint->topLeftCorner<3, 3>(), joint->bottomRightCorner<3, 3>(),
                              joint->topRightCorner<3, 3>()};
    motions.push_back(between(pose(k), pose(newest), pair));
  }
  return motions;
}

}  // namespace fathom
