#include "residuals.hpp"

#include <algorithm>
#include <cmath>

#include "fathom/core/median.hpp"

namespace fathom {

double seconds_of(const SeenMotion& motion) {
  return 1e-9 * std::abs(static_cast<double>(motion.to_ns - motion.from_ns));
}

Eigen::Vector3d change_of(std::span<const SeenMotion> motions, std::size_t i) {
  const SeenMotion& motion = motions[i];
  Eigen::Vector3d change = Eigen::Vector3d::Zero();
  double sides = 0.0;
  const auto add = [&](const SeenMotion& other, double sense) {
    const double share = seconds_of(motion) / seconds_of(other);
    const double apart_s = 0.5 * (seconds_of(motion) + seconds_of(other));
    change += sense * (share * other.camera.vector() - motion.camera.vector()) / apart_s;
    sides += 1.0;
  };
  if (i > 0 && motions[i - 1].to_ns == motion.from_ns) add(motions[i - 1], -1.0);
  if (i + 1 < motions.size() && motions[i + 1].from_ns == motion.to_ns) add(motions[i + 1], 1.0);
  // Of pictures counted from the end time runs backwards.
  if (motion.to_ns < motion.from_ns) change = -change;
  return sides > 0.0 ? Eigen::Vector3d(change / sides) : change;
}

Eigen::Matrix2d arm_of(const Beside& one) {
  return Eigen::Matrix2d::Identity() - rotation(one.seen.theta);
}

Eigen::Vector2d turned(const Beside& one, const SetUpParameters& p) {
  return std::exp(p.log_scale) * (rotation(p.yaw_rad) * one.seen.position());
}

Eigen::Vector3d shifted(const Beside& one, const SetUpParameters& p) {
  constexpr double kQuarter = 1.5707963267948966;
  const Eigen::Matrix2d arm = -one.change.z() * rotation(one.seen.theta + kQuarter);
  Eigen::Vector3d change;
  change << arm * Eigen::Vector2d(p.lever_x_m, p.lever_y_m) +
                std::exp(p.log_scale) * (rotation(p.yaw_rad) * one.change.head<2>()),
      one.change.z();
  return -change;
}

Eigen::Vector3d residual_of(const Beside& one, const SetUpParameters& p) {
  const Eigen::Vector2d body =
      arm_of(one) * Eigen::Vector2d(p.lever_x_m, p.lever_y_m) + turned(one, p);
  Eigen::Vector3d e;
  e << one.reckoned.position() - body, wrap_angle(one.reckoned.theta - one.seen.theta);
  return e / one.noise;
}

double ResidualSpread::squared(const Eigen::Vector3d& e) const {
  return e.head<2>().squaredNorm() / (sigma_m * sigma_m) + e.z() * e.z() / (sigma_rad * sigma_rad);
}

double ResidualSpread::log_density(const std::vector<Beside>& beside,
                                   const SetUpParameters& p) const {
  double sum = 0.0;
  for (const Beside& one : beside) {
    sum += kT.log_density(squared(residual_of(one, p)));
  }
  return sum - static_cast<double>(beside.size()) * (2.0 * std::log(sigma_m) + std::log(sigma_rad));
}

ResidualSpread spread_of(const std::vector<Beside>& beside, const SetUpParameters& p) {
  constexpr double kLeast_m = 1e-5;
  constexpr double kLeast_rad = 1e-6;
  constexpr int kRounds = 8;
  std::vector<Eigen::Vector3d> residuals;
  std::vector<double> lengths_m;
  std::vector<double> turns_rad;
  for (const Beside& one : beside) {
    const Eigen::Vector3d e = residual_of(one, p);
    residuals.push_back(e);
    lengths_m.push_back(e.head<2>().norm());
    turns_rad.push_back(std::abs(e.z()));
  }
  ResidualSpread spread{std::max(kLeast_m, upper_median(lengths_m) / kRayleighMedian),
                        std::max(kLeast_rad, upper_median(turns_rad) / kHalfNormalMedian)};
  // Expectation maximisation of the two scales.
  const auto count = static_cast<double>(beside.size());
  for (int round = 0; round < kRounds; ++round) {
    double squares_m = 0.0;
    double squares_rad = 0.0;
    for (const Eigen::Vector3d& e : residuals) {
      squares_m += spread.weight(e) * e.head<2>().squaredNorm();
      squares_rad += spread.weight(e) * e.z() * e.z();
    }
    spread = {std::max(kLeast_m, std::sqrt(squares_m / (2.0 * count))),
              std::max(kLeast_rad, std::sqrt(squares_rad / count))};
  }
  return spread;
}

}  // namespace fathom
