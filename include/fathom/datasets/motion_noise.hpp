#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "fathom/core/ignored_key.hpp"
#include "fathom/core/options.hpp"
#include "fathom/core/random.hpp"
#include "fathom/geometry/pose.hpp"

namespace fathom {

enum class OdometrySource { kNoisyMotion, kVisualOdometry };

/// Dead reckoning of a simulation and the noise it is given per frame, in the frame before. What is
/// told of it is the covariance of one frame's noise, however the noise of frames is correlated.
struct OdometryOptions {
  OdometrySource source = OdometrySource::kNoisyMotion;
  double sigma_x_m = 0.01;
  double sigma_y_m = 0.01;
  double sigma_theta_rad = 0.005;
  std::vector<double> covariance;  ///< [xx, xy, xt, yy, yt, tt]; empty: from the sigmas
  /// Of the noise's covariance, what GaussMarkovNoise draws; the rest is white.
  double correlated_share = 0.0;
  double correlation_length_m = 2.0;

  void describe(OptionTable& table);
  /// Visual odometry adds white noise alone.
  std::vector<IgnoredKey> ignored_keys() const;

  /// The covariance of the noise of one frame. Throws InputError naming `key_prefix` + the key
  /// that makes it other than positive definite, for it must be inverted later. Visual odometry has
  /// a covariance of its own to which this one is added, so there it may be zero altogether.
  Eigen::Matrix3d noise_covariance(const std::string& key_prefix) const;
};

/// Noise that a study adds to motions that are measured, recorded ones or those of visual odometry.
struct AddedNoiseOptions {
  double sigma_x_m = 0.0;
  double sigma_y_m = 0.0;
  double sigma_theta_rad = 0.0;
  std::vector<double> covariance;  ///< [xx, xy, xt, yy, yt, tt]; empty: from the sigmas

  void describe(OptionTable& table);

  /// As of OdometryOptions; zero altogether is no noise.
  Eigen::Matrix3d noise_covariance(const std::string& key_prefix) const;
};

/// Noise of measurements that are drawn, each with the covariance that its estimators are told.
struct DrawnNoiseOptions {
  std::string of;  ///< what it is noise of, for the help: "of a frame's motion"
  double sigma_x_m = 0.01;
  double sigma_y_m = 0.01;
  double sigma_theta_rad = 0.005;
  std::vector<double> covariance = {};  ///< [xx, xy, xt, yy, yt, tt]; empty: from the sigmas

  void describe(OptionTable& table);

  /// Throws InputError naming `key_prefix` + the key that makes it other than positive definite.
  Eigen::Matrix3d noise_covariance(const std::string& key_prefix) const;
};

/// What is added to each motion: draws of this covariance, which must be positive definite or zero.
struct AddedNoise {
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  std::uint64_t seed = 0;
  std::uint64_t trial = 0;
};

/// Draws zero-mean Gaussian noise of (x, y, θ) with a given covariance.
class MotionNoise {
 public:
  /// Positive definite, or zero.
  explicit MotionNoise(const Eigen::Matrix3d& covariance);

  Eigen::Vector3d draw(RandomStream& stream) const;

  /// The pose with a draw added to its (x, y, θ); heading wrapped.
  Pose disturb(const Pose& motion, RandomStream& stream) const;

 private:
  Eigen::Matrix3d lower_;  ///< covariance = lower lowerᵀ
};

/// Draws zero-mean Gaussian noise of (x, y, θ) whose covariance is the same everywhere, and whose
/// correlation falls exponentially along the way: E e(s) e(s + d)ᵀ = C exp(−d / length), a
/// first-order Gauss-Markov process. So are the errors of odometry that come from its calibration
/// and from what it sees: they stay alike for a while.
class GaussMarkovNoise {
 public:
  /// Positive definite, or zero; length > 0.
  GaussMarkovNoise(const Eigen::Matrix3d& covariance, double length_m);

  /// `way_m` further than the draw before.
  Eigen::Vector3d draw(double way_m, RandomStream& stream);

 private:
  MotionNoise noise_;
  double length_m_;
  std::optional<Eigen::Vector3d> last_;  ///< none: the first draw is that of the stationary process
};

}  // namespace fathom
