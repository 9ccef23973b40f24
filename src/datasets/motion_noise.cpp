#include "fathom/datasets/motion_noise.hpp"

#include <cmath>

#include <Eigen/Cholesky>

#include "fathom/core/input_error.hpp"
#include "fathom/geometry/covariance.hpp"

namespace fathom {
namespace {

template <class Options>
Eigen::Matrix3d covariance_of(const Options& options, bool may_be_zero, const std::string& prefix) {
  Eigen::Matrix3d C = Eigen::Matrix3d::Zero();
  const std::vector<double>& c = options.covariance;
  if (c.empty()) {
    const Eigen::Vector3d sigmas{options.sigma_x_m, options.sigma_y_m, options.sigma_theta_rad};
    C = sigmas.cwiseAbs2().asDiagonal();
  } else if (c.size() == 6) {
    C << c[0], c[1], c[2], c[1], c[3], c[4], c[2], c[4], c[5];
  } else {
    throw InputError(prefix + "covariance: expected six numbers [xx, xy, xt, yy, yt, tt], or []");
  }
  if (is_positive_definite(C) || (may_be_zero && C.isZero(0.0))) return C;
  if (!c.empty()) {
    throw InputError(prefix + "covariance: is not positive definite; expected xx, yy, tt > 0 and " +
                     "correlations between -1 and 1");
  }
  // Of a sigma near the ends of what doubles hold the square is 0 or infinite.
  const auto is_variance = [&C](int i) { return C(i, i) > 0.0 && std::isfinite(C(i, i)); };
  const std::string key = !is_variance(0)   ? "sigma_x_m"
                          : !is_variance(1) ? "sigma_y_m"
                                            : "sigma_theta_rad";
  throw InputError(prefix + key + ": makes the covariance singular; expected a number > 0");
}

}  // namespace

void OdometryOptions::describe(OptionTable& table) {
  table.enumeration(
      "source", source,
      {{"noisy_motion", OdometrySource::kNoisyMotion},
       {"visual_odometry", OdometrySource::kVisualOdometry}},
      "dead reckoning: the true motion with noise, or registered pictures with noise");
  table.real("sigma_x_m", sigma_x_m, Range::at_least(0), "m", "noise per frame, forward");
  table.real("sigma_y_m", sigma_y_m, Range::at_least(0), "m", "noise per frame, to port");
  table.real("sigma_theta_rad", sigma_theta_rad, Range::at_least(0), "rad",
             "noise per frame, heading");
  table.reals("covariance", covariance, 6, "",
              "noise per frame [xx, xy, xt, yy, yt, tt] in m^2, m rad, rad^2; []: from the sigmas");
  table.real("correlated_share", correlated_share, Range::between(0, 1), "",
             "of this covariance, the part that is correlated along the way, the rest being white; "
             "the stated covariance is that of single frames all the same");
  table.real("correlation_length_m", correlation_length_m, Range::positive(), "m",
             "the way over which that correlation falls to 1/e");
}

std::vector<IgnoredKey> OdometryOptions::ignored_keys() const {
  if (source == OdometrySource::kVisualOdometry) {
    return {{"correlated_share", "source"}, {"correlation_length_m", "source"}};
  }
  if (correlated_share == 0.0) return {{"correlation_length_m", "correlated_share"}};
  return {};
}

void AddedNoiseOptions::describe(OptionTable& table) {
  table.real("sigma_x_m", sigma_x_m, Range::at_least(0), "m",
             "noise added to each frame's motion, forward");
  table.real("sigma_y_m", sigma_y_m, Range::at_least(0), "m", "noise added, to port");
  table.real("sigma_theta_rad", sigma_theta_rad, Range::at_least(0), "rad",
             "noise added, heading; all three zero: none");
  table.reals("covariance", covariance, 6, "",
              "noise added [xx, xy, xt, yy, yt, tt] in m^2, m rad, rad^2; []: from the sigmas");
}

void DrawnNoiseOptions::describe(OptionTable& table) {
  table.real("sigma_x_m", sigma_x_m, Range::at_least(0), "m", "noise " + of + ", forward");
  table.real("sigma_y_m", sigma_y_m, Range::at_least(0), "m", "noise " + of + ", to port");
  table.real("sigma_theta_rad", sigma_theta_rad, Range::at_least(0), "rad",
             "noise " + of + ", heading");
  table.reals(
      "covariance", covariance, 6, "",
      "noise " + of + " [xx, xy, xt, yy, yt, tt] in m^2, m rad, rad^2; []: from the sigmas");
}

Eigen::Matrix3d OdometryOptions::noise_covariance(const std::string& prefix) const {
  return covariance_of(*this, source == OdometrySource::kVisualOdometry, prefix);
}

Eigen::Matrix3d AddedNoiseOptions::noise_covariance(const std::string& prefix) const {
  return covariance_of(*this, true, prefix);
}

Eigen::Matrix3d DrawnNoiseOptions::noise_covariance(const std::string& prefix) const {
  return covariance_of(*this, false, prefix);
}

MotionNoise::MotionNoise(const Eigen::Matrix3d& covariance) : lower_(Eigen::Matrix3d::Zero()) {
  if (!covariance.isZero(0.0)) lower_ = covariance.llt().matrixL();
}

Eigen::Vector3d MotionNoise::draw(RandomStream& stream) const {
  Eigen::Vector3d standard;
  for (double& value : standard) value = stream.normal();
  return lower_ * standard;
}

Pose MotionNoise::disturb(const Pose& motion, RandomStream& stream) const {
  const Eigen::Vector3d noisy = motion.vector() + draw(stream);
  return {noisy.x(), noisy.y(), wrap_angle(noisy.z())};
}

GaussMarkovNoise::GaussMarkovNoise(const Eigen::Matrix3d& covariance, double length_m)
    : noise_(covariance), length_m_(length_m) {}

Eigen::Vector3d GaussMarkovNoise::draw(double way_m, RandomStream& stream) {
  const Eigen::Vector3d fresh = noise_.draw(stream);
  const double kept = last_ ? std::exp(-way_m / length_m_) : 0.0;
  last_ = kept * last_.value_or(Eigen::Vector3d::Zero()) + std::sqrt(1.0 - kept * kept) * fresh;
  return *last_;
}

}  // namespace fathom
