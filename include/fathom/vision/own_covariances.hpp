#pragma once

#include <array>

#include <Eigen/Core>

#include "fathom/measurements/shared_errors.hpp"

namespace fathom {

/// A registration's own covariance by what is told of its pictures beside it. What a survey's loops
/// find of altitudes and tilts changes it, without the pictures.
struct OwnCovariances {
  /// Where altitudes (bit 0) and tilts (bit 1) are told: what they do to the matches is not its
  /// own. Where the options state them, both are alike.
  std::array<Eigen::Matrix3d, 4> by_told{Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Zero(),
                                         Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Zero()};
  /// What tilts do to the motion beyond G n, for a σ of 1 rad; it goes by σ⁴.
  Eigen::Matrix3d bend_from = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d bend_to = Eigen::Matrix3d::Zero();

  /// With the standard deviations of the two pictures' n as they are in force.
  Eigen::Matrix3d beside(const PictureErrors& from, const PictureErrors& to) const;

  void scale(double factor);

  bool operator==(const OwnCovariances&) const = default;
};

}  // namespace fathom
