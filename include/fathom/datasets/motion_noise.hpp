#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "fathom/core/options.hpp"
#include "fathom/core/random.hpp"

namespace fathom {

enum class OdometrySource { kNoisyMotion, kVisualOdometry };

/// Dead reckoning of a simulation and the noise it is given per frame, in the frame before.
struct OdometryOptions {
  OdometrySource source = OdometrySource::kNoisyMotion;
  double sigma_x_m = 0.01;
  double sigma_y_m = 0.01;
  double sigma_theta_rad = 0.005;
  std::vector<double> covariance;  ///< [xx, xy, xt, yy, yt, tt]; empty: from the sigmas

  void describe(OptionTable& table);

  /// The covariance of the noise of one frame. Throws InputError naming `key_prefix` + the key
  /// that makes it other than positive definite, for it must be inverted later. Visual odometry has
  /// a covariance of its own to which this one is added, so there it may be zero altogether.
  Eigen::Matrix3d noise_covariance(const std::string& key_prefix) const;
};

/// Draws zero-mean Gaussian noise of (x, y, θ) with a given covariance.
class MotionNoise {
 public:
  /// Positive definite, or zero.
  explicit MotionNoise(const Eigen::Matrix3d& covariance);

  Eigen::Vector3d draw(RandomStream& stream) const;

 private:
  Eigen::Matrix3d lower_;  ///< covariance = lower lowerᵀ
};

}  // namespace fathom
